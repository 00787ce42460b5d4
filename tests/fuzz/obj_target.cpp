/* The OBJ reader takes any text: it gives a mesh whose indices are good and whose vertices are finite, or an Error that names the file. */
#include <cmath>
#include <cstdlib>

#include "error.h"
#include "obj_reader.h"
#include "target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  const std::string text(reinterpret_cast<const char *>(data), size);
  try {
    const runner::Mesh mesh = runner::parse_obj("mesh.obj", text);
    if (mesh.indices.empty() || mesh.indices.size() % 3 != 0) std::abort();
    for (const std::uint32_t index : mesh.indices)
      if (index >= mesh.vertices.size()) std::abort();
    for (const runner::Vector3 &vertex : mesh.vertices)
      if (!std::isfinite(vertex.x) || !std::isfinite(vertex.y) || !std::isfinite(vertex.z)) std::abort();
  } catch (const runner::Error &error) {
    if (std::string(error.what()).find("mesh.obj") == std::string::npos) std::abort();
  }
  return 0;
}
