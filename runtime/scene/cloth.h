// The cloths of a world as the host described them.
#pragma once

#include <memory>
#include <vector>

#include <loam/cloth.h>

#include "kernels/contact/collider_view.h"
#include "scene/cloth_mesh.h"
#include "scene/slot_table.h"
#include "solver/cloth_backend.h"

namespace loam {

loam_cloth_def default_cloth();
loam_cloth_attachment_def default_attachment();

// Throws Error naming field and value. `thickness` stands in for one of 0.
SolverCloth make_cloth(const loam_cloth_def &def, const ClothMesh &mesh, float thickness);

// Throws Error naming field and value.
void check_wind(const ClothWind &wind);

// Which slot of the colliders' table each attachment refers to, and where that collider is among those of a step.
class ClothScene {
public:
  ClothScene(std::uint16_t world_tag, float default_thickness)
      : cloths_(IdKind::cloth, "cloth", world_tag, 4096), default_thickness_(default_thickness) {}

  loam_cloth_id create(ClothBackend &backend, const loam_cloth_def &def);
  void destroy(ClothBackend &backend, loam_cloth_id id);
  // `collider` is the slot of def.collider, -1 for space; `pose` is where it is now.
  void attach(ClothBackend &backend, loam_cloth_id id, const loam_cloth_attachment_def &def, int collider, const Pose &pose);
  void release(ClothBackend &backend, loam_cloth_id id, const std::uint32_t *vertices, std::uint32_t count);
  void set_wind(ClothBackend &backend, loam_cloth_id id, const float velocity[3], float drag, float lift);
  void map(ClothBackend &backend, loam_cloth_id id, loam_cloth_view &view);
  void unmap(loam_cloth_id id);

  // What is attached in space moves along; the vertices are the solver's.
  void shift_origin(ClothBackend &backend, const Vec3<float> &by);

  // For snapshots, see scene/world_snapshot.cpp. What changes after a cloth was made:
  struct Changes {
    std::vector<SolverAttachment> attachments; // with colliders by their slots
    ClothWind wind{};
    std::vector<TornCorner> torn;
  };
  std::size_t slot_count() const { return cloths_.size(); }
  struct Description {
    loam_cloth_def def; // without the mesh
    std::uint64_t mesh; // its fingerprint
    std::uint32_t vertex_count, triangle_count;
  };
  // Null if there is none in the slot.
  const Description *description(std::size_t slot) const;
  Changes changes(const ClothBackend &backend, std::size_t slot) const;
  bool could_be_torn(const ClothBackend &backend, std::size_t slot, const std::vector<TornCorner> &torn) const;
  // All or none of them, by slot.
  void set_changes(ClothBackend &backend, const std::vector<Changes> &changes);
  // Of cloths that are torn as these say.
  void list_state(ClothBackend &backend, const std::vector<Changes> &changes, std::vector<StateSection> &list) const;

  bool any() const { return count_ > 0; }
  std::uint64_t vertex_count() const;
  bool any_mapped() const { return mapped_ > 0; }
  // Throws IN_USE if a cloth is attached to the collider in this slot.
  void check_unattached(int collider_slot) const;
  // Before a step: where each slot of the colliders' table is among the step's colliders.
  void use_colliders(ClothBackend &backend, const std::vector<int> &index_of_slot);

private:
  struct Cloth {
    int backend = -1;
    std::shared_ptr<const ClothMesh> mesh;
    Changes changes;
    Description description{};
    bool mapped = false;
  };
  void send(ClothBackend &backend, const Cloth &cloth) const;
  Cloth &changeable(loam_cloth_id id);

  SlotTable<Cloth> cloths_;
  float default_thickness_;
  std::vector<int> index_of_slot_;
  int count_ = 0, mapped_ = 0;
};

} // namespace loam
