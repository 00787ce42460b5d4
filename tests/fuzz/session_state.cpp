/* What changes the state beside steps: particles taken out and moved, the origin, snapshots and kept frames. */
#include "session_actions.h"

namespace loam::fuzz {

// ------------------------------------------------------------------------------------------------- particles in bulk ---

std::vector<std::uint32_t> Session::some_ids(Random &random) const {
  std::vector<std::uint32_t> ids;
  const double share = random.chance(0.1) ? 1 : random.log_between(0.01, 1);
  for (std::size_t id = 0; id < now_.particles.size(); ++id)
    if (now_.particles[id].here && random.chance(share)) ids.push_back(std::uint32_t(id));
  if (random.chance(0.5)) std::reverse(ids.begin(), ids.end());
  return ids;
}

void Session::remove(Random &random) {
  const std::vector<std::uint32_t> ids = some_ids(random);
  if (!call("remove", mapped_ ? Expect::in_use : Expect::success,
            [&] { return loam_particles_remove(world_, ids.data(), ids.size()); }))
    return;
  now_.count -= ids.size();
  for (const std::uint32_t id : ids) {
    now_.particles[id].here = false;
    for (Material &material : now_.materials)
      if (std::uint32_t(material.id) == now_.particles[id].material) --material.particles;
  }
  look();
}

void Session::move(Random &random) {
  const std::vector<std::uint32_t> ids = some_ids(random);
  const float r = def_.kernel_radius;
  float centre[3], unused[4];
  random_place(random, r, centre, unused);
  const bool shift = random.chance(0.5); // from where they are, or to a cloud
  const double extent = random.log_between(0.01, 8), speed = random.log_between(0.01, 100);
  std::vector<float> positions, velocities;
  for (const std::uint32_t id : ids)
    for (int k = 0; k < 3; ++k) {
      const float from = shift ? now_.particles[id].position[k] : centre[k];
      positions.push_back(std::clamp(from + r * random.between(-extent, extent), -9e5f * r, 9e5f * r));
      velocities.push_back(random.between(-speed, speed));
    }
  const bool where = random.chance(0.7), how_fast = !where || random.chance(0.5);
  if (call("move", mapped_ ? Expect::in_use : Expect::success, [&] {
        return loam_particles_move(world_, ids.data(), ids.size(), where ? positions.data() : nullptr,
                                   how_fast ? velocities.data() : nullptr);
      }))
    look();
}

void Session::bad_bulk(Random &random) {
  std::vector<std::uint32_t> ids = some_ids(random);
  if (ids.empty()) return;
  std::vector<float> values(3 * ids.size(), 0.0f);
  const bool moves = random.chance(0.5);
  const std::uint32_t flaw = random.below(moves ? 5 : 3);
  std::uint64_t count = ids.size();
  if (flaw == 0) ids[random.below(ids.size())] = std::uint32_t(now_.particles.size()) + random.below(1000);
  if (flaw == 1 && ids.size() == 1) return;
  if (flaw == 1) ids[0] = ids[1 + random.below(ids.size() - 1)];
  if (flaw == 2) count = random.chance(0.5) ? ~std::uint64_t(0) : now_.count + 1; // read no further than that is known
  if (flaw == 2) ids.resize(now_.count + 1), values.resize(3 * ids.size());
  if (flaw == 3) values[random.below(values.size())] = bad_number(random);
  const bool none = flaw == 4;
  call("bad bulk", Expect::failure, [&] {
    if (!moves) return loam_particles_remove(world_, ids.data(), count);
    return loam_particles_move(world_, ids.data(), count, none ? nullptr : values.data(), none ? nullptr : values.data());
  });
}

// ------------------------------------------------------------------------------------------------------------ origin ---

void Session::shift_origin(Random &random) {
  float offset[3];
  const double reach = random.chance(0.1) ? 1e4 : 8;
  for (float &component : offset) component = def_.kernel_radius * random.between(-reach, reach);
  if (!call("shift origin", mapped_ ? Expect::in_use : Expect::success,
            [&] { return loam_world_shift_origin(world_, offset); }))
    return;
  for (Collider &collider : now_.colliders)
    for (int k = 0; k < 3; ++k) {
      collider.position[k] -= offset[k];
      collider.target_position[k] -= offset[k];
    }
  look();
}

void Session::wake(Random &) {
  call("wake", mapped_ ? Expect::anything : Expect::success, [&] { return loam_world_wake(world_); });
}

// -------------------------------------------------------------------------------------------------------- kept frames ---

void Session::keep(Random &random) {
  if (kept_ != nullptr && !std::equal(kept_positions_.begin(), kept_positions_.end(), kept_,
                                      [](float a, float b) { return std::memcmp(&a, &b, sizeof a) == 0; }))
    find("a kept frame has changed");
  if (random.chance(0.3)) {
    if (call("drop", kept_ != nullptr ? Expect::success : Expect::invalid, [&] { return loam_particles_drop(world_); }))
      kept_ = nullptr;
    return;
  }
  loam_particle_view view = {};
  view.struct_size = sizeof view;
  if (!call("keep", Expect::success, [&] { return loam_particles_keep(world_, &view); })) return;
  check_view(view);
  kept_ = view.positions;
  kept_positions_.assign(view.positions, view.positions + 4 * view.count);
}

// ---------------------------------------------------------------------------------------------------------- snapshots ---

bool Session::save_to(std::vector<unsigned char> &bytes) {
  std::uint64_t size = 0, written = 0;
  judge("snapshot size", Expect::success, loam_snapshot_size(world_, &size));
  bytes.assign(size, 0);
  const loam_status status = loam_snapshot_save(world_, bytes.data(), bytes.size(), &written);
  judge("save", Expect::success, status);
  if (status == LOAM_OK && written != size)
    find("a snapshot of %zu bytes, not %zu", std::size_t(written), std::size_t(size));
  return status == LOAM_OK;
}

void Session::save(Random &) {
  if (leaves_out()) return;
  Saved saved = {{}, hash(), description_, now_};
  if (save_to(saved.bytes)) saved_ = std::move(saved);
  if (hash() != saved_.hash) find("saving changed the state");
}

void Session::restore(Random &random) {
  if (saved_.bytes.empty()) return;
  std::vector<unsigned char> bytes = saved_.bytes;
  const bool damage = random.chance(0.3);
  if (damage) {
    const std::size_t at = random.below(bytes.size());
    if (random.chance(0.3))
      bytes.resize(at);
    else
      bytes[at] ^= (unsigned char)(1 + random.below(255));
  }
  const bool same = saved_.description == description_;
  const Expect expect = damage || mapped_ ? Expect::failure : same ? Expect::success : Expect::anything;
  if (!call("restore", expect, [&] { return loam_snapshot_restore(world_, bytes.data(), bytes.size()); })) return;
  if (!same) return destroy_world(); // it was described alike after all; but what is where is not known here
  if (hash() != saved_.hash) find("what was restored is not what was saved");
  now_ = saved_.known;
  look();
}

/* A step, back, and the same again. */
void Session::roll_back(Random &random) {
  const float seconds = random.log_between(5e-4, 0.03);
  if (mapped_ || def_.pair_capacity != 0 || def_.allocator.allocate != nullptr || leaves_out()) return;
  const std::uint64_t start = hash();
  std::vector<unsigned char> bytes;
  if (!save_to(bytes)) return;
  judge("step ahead", a_stream_tells() ? Expect::room_or_none : Expect::success, loam_world_step(world_, seconds));
  const std::uint64_t end = hash();
  judge("go back", Expect::success, loam_snapshot_restore(world_, bytes.data(), bytes.size()));
  if (hash() != start) find("going back did not lead back");
  step_for(seconds, false);
  if (hash() != end) find("after going back the world steps otherwise");
}

} // namespace loam::fuzz
