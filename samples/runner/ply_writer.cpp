#include "ply_writer.h"

#include <bit>
#include <cstring>

#include <fmt/format.h>

namespace runner {
namespace {

struct Row {
  float position[3];
  float velocity[3];
  std::uint32_t id;
  std::uint32_t material;
};
static_assert(sizeof(Row) == 32, "rows are written as they lie in memory");
static_assert(std::endian::native == std::endian::little, "a big-endian machine would have to swap bytes here");

} // namespace

std::string make_ply(const Particles &particles, const std::string &comment) {
  std::string file = fmt::format("ply\n"
                                 "format binary_little_endian 1.0\n"
                                 "comment {}\n"
                                 "element vertex {}\n"
                                 "property float x\nproperty float y\nproperty float z\n"
                                 "property float vx\nproperty float vy\nproperty float vz\n"
                                 "property uint id\n"
                                 "property uint material\n"
                                 "end_header\n",
                                 comment, particles.count());
  const std::size_t header = file.size();
  file.resize(header + particles.count() * sizeof(Row));
  char *out = file.data() + header;
  for (std::size_t i = 0; i < particles.count(); ++i, out += sizeof(Row)) {
    const Vector3 x = particles.positions[i], v = particles.velocities[i];
    const Row row = {{x.x, x.y, x.z}, {v.x, v.y, v.z}, particles.ids[i], particles.materials[i]};
    std::memcpy(out, &row, sizeof row);
  }
  return file;
}

} // namespace runner
