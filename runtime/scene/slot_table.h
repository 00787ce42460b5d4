// Objects named by ids: a stale id is recognised, never taken for another object. From the top, an id holds
//
//     kind (3 bits) | tag of the world (13 bits) | generation (16 bits) | index (32 bits)
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "scene/error.h"

namespace loam {

enum class IdKind : std::uint8_t {
  material = 1,
  collider = 2,
  cloth = 3,
  emitter = 4,
  field = 5,
  killer = 6
}; // at most 7: an id of one kind is never good for another

template <class T> class SlotTable {
public:
  // `world_tag` is 1 to greatest_tag.
  SlotTable(IdKind kind, const char *name, std::uint16_t world_tag, std::size_t most)
      : name_(name), tag_(static_cast<std::uint16_t>(static_cast<unsigned>(kind) << tag_bits | world_tag)), most_(most) {}
  static constexpr unsigned tag_bits = 13, greatest_tag = (1u << tag_bits) - 1;

  // The id that the next add() will give. Throws Error CAPACITY if there is no room.
  std::uint64_t next_id() const {
    const std::size_t index = free_slot();
    if (index == most_) throw Error(LOAM_ERROR_CAPACITY, format("a world holds at most %zu %ss", most_, name_));
    const std::uint16_t generation = index < slots_.size() ? slots_[index].generation : 1;
    return make_id(index, generation);
  }
  std::uint64_t add(T object) {
    const std::uint64_t id = next_id();
    const auto index = static_cast<std::size_t>(id & 0xffffffffu);
    if (index == slots_.size()) slots_.push_back({T(), 1});
    slots_[index].object = std::move(object);
    slots_[index].in_use = true;
    return id;
  }
  // Throws Error INVALID_HANDLE.
  std::size_t index_of(std::uint64_t id, const char *argument) const {
    const auto index = static_cast<std::size_t>(id & 0xffffffffu);
    const auto generation = static_cast<std::uint16_t>(id >> 32), tag = static_cast<std::uint16_t>(id >> 48);
    const char *why = nullptr;
    if (id == 0)
      why = "is the null id";
    else if ((tag & greatest_tag) != (tag_ & greatest_tag))
      why = "is not of this world";
    else if (tag != tag_)
      why = "names something of another kind";
    else if (index >= slots_.size() || generation > slots_[index].generation)
      why = "was never given out";
    else if (!slots_[index].in_use || generation != slots_[index].generation)
      why = "is stale: its object was destroyed";
    if (why != nullptr)
      throw Error(LOAM_ERROR_INVALID_HANDLE,
                  format("%s 0x%016llx %s (a %s was expected)", argument, static_cast<unsigned long long>(id), why, name_));
    return index;
  }
  T &at(std::uint64_t id, const char *argument) { return slots_[index_of(id, argument)].object; }
  const T &at(std::uint64_t id, const char *argument) const { return slots_[index_of(id, argument)].object; }
  void remove(std::uint64_t id, const char *argument) {
    Slot &slot = slots_[index_of(id, argument)];
    slot.object = T();
    slot.in_use = false;
    if (slot.generation == last_generation)
      slot.retired = true; // another object in it would bear an id that was given out before
    else
      ++slot.generation;
  }
  std::size_t size() const { return slots_.size(); }
  bool empty() const {
    return std::none_of(slots_.begin(), slots_.end(), [](const Slot &slot) { return slot.in_use; });
  }
  T *at_index(std::size_t index) { return slots_[index].in_use ? &slots_[index].object : nullptr; }
  const T *at_index(std::size_t index) const { return slots_[index].in_use ? &slots_[index].object : nullptr; }

private:
  struct Slot {
    T object;
    std::uint16_t generation;
    bool in_use = false, retired = false;
  };
  static constexpr std::uint16_t last_generation = 0xffff;
  std::size_t free_slot() const {
    for (std::size_t i = 0; i < slots_.size(); ++i)
      if (!slots_[i].in_use && !slots_[i].retired) return i;
    return slots_.size();
  }
  std::uint64_t make_id(std::size_t index, std::uint16_t generation) const {
    return (static_cast<std::uint64_t>(tag_) << 48) | (static_cast<std::uint64_t>(generation) << 32) | index;
  }

  const char *name_;
  std::uint16_t tag_; // and the kind
  std::size_t most_;
  std::vector<Slot> slots_;
};

} // namespace loam
