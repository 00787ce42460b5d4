/* Any bytes are refused or make a world that steps: the checksum is made to fit, so that what lies behind it is reached. A refused snapshot changes nothing.
 *
 * Files of the corpus are lists of changes to a snapshot of a small world, four bytes each: place (two bytes), how, value. So they stay good when the
 * format changes. How, by its remainder by 4: set the byte, add to it, set four bytes from there, cut the snapshot short there. */
#include <cstdlib>
#include <vector>

#include "support/deforming.h"
#include "support/forged_snapshot.h"
#include "target.h"

namespace {

using namespace loam;

struct Subject {
  scenes::World world = make();
  snapshots::Bytes saved = snapshots::save(world.get());
  std::uint64_t hash = world.state_hash();

  static scenes::World make() {
    const scenes::Scene sand = scenes::jittered_block(scenes::sand(), 6);
    scenes::Scene clay = scenes::jittered_block(scenes::plasticine(), 6);
    clay.planes.clear();
    loam_world_def def = scenes::world_def(sand);
    def.particle_capacity = 16;
    def.substeps = 2;
    def.iterations = 2;
    scenes::World world(def, sand);
    world.add(clay);
    loam_cloth_def cloth;
    scenes::require(loam_cloth_def_default(&cloth, sizeof cloth), "loam_cloth_def_default");
    const float positions[12] = {0, 0, 0, 0.01f, 0, 0, 0, 0, 0.01f, 0.01f, 0, 0.01f};
    const std::uint32_t indices[6] = {0, 2, 1, 1, 2, 3}, corner = 0;
    cloth.mesh = {positions, indices, 4, 2};
    loam_cloth_id id = 0;
    scenes::require(loam_cloth_create(world.get(), &cloth, &id), "loam_cloth_create");
    loam_cloth_attachment_def attachment;
    scenes::require(loam_cloth_attachment_def_default(&attachment, sizeof attachment), "loam_cloth_attachment_def_default");
    attachment.count = 1;
    attachment.vertices = &corner;
    scenes::require(loam_cloth_attach(world.get(), id, &attachment), "loam_cloth_attach");
    const meshes::Mesh skin = meshes::box(0.02f, 0.02f, 0.02f);
    deforming::move(world, deforming::add(world, skin), deforming::moved(skin, [](float *x) { x[1] *= 1.1f; }));
    world.step(1e-3f);
    return world;
  }
};

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  static Subject subject;
  snapshots::Bytes bytes = subject.saved;
  for (std::size_t i = 0; i + 4 <= size && !bytes.empty(); i += 4) {
    const std::size_t at = (data[i] + 256u * data[i + 1]) % bytes.size();
    const auto value = static_cast<std::byte>(data[i + 3]);
    switch (data[i + 2] % 4) {
    case 0:
      bytes[at] = value;
      break;
    case 1:
      bytes[at] = static_cast<std::byte>(static_cast<unsigned>(bytes[at]) + static_cast<unsigned>(value));
      break;
    case 2:
      for (std::size_t k = at; k < std::min(at + 4, bytes.size()); ++k) bytes[k] = value;
      break;
    default:
      bytes.resize(at);
    }
  }
  snapshots::forge(bytes);
  loam_world *world = subject.world.get();
  if (loam_snapshot_restore(world, bytes.data(), bytes.size()) == LOAM_OK) {
    if (loam_world_step(world, 1e-3f) != LOAM_OK) std::abort();
    snapshots::restore(world, subject.saved);
  }
  if (subject.world.state_hash() != subject.hash) std::abort();
  return 0;
}
