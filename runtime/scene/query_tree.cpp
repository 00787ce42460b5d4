#include "scene/query_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace loam {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// The least half extent about a centre that reaches both ends whatever is rounded.
float half_extent(float centre, float lower, float upper) {
  const double half = std::max(double(upper) - centre, double(centre) - lower);
  return std::nextafter(float(half), infinity);
}

struct Bounds {
  Vec3<float> lower, upper;
};

class QueryTree {
public:
  explicit QueryTree(BoundingVolumeHierarchy &hierarchy) : hierarchy_(hierarchy) {
    first_.resize(hierarchy.binary.size());
    count_.resize(hierarchy.binary.size());
    for (std::size_t n = hierarchy.binary.size(); n-- > 0;) {
      const BinaryNode &node = hierarchy.binary[n];
      first_[n] = first_of(node.child[0]);
      count_[n] = count_of(node.child[0]) + (node.lower[1].x <= node.upper[1].x ? count_of(node.child[1]) : 0);
    }
  }

  void build() {
    struct Open {
      std::uint32_t binary, parent;
      int lane;
    };
    std::vector<Open> stack{{0, 0, -1}};
    while (!stack.empty()) {
      const Open open = stack.back();
      stack.pop_back();
      const auto own = std::uint32_t(hierarchy_.nodes.size());
      if (open.lane >= 0) hierarchy_.nodes[open.parent].child[open.lane] = own;
      hierarchy_.nodes.emplace_back();
      Child children[BvhNode::width];
      const int count = collect(open.binary, children);
      for (int k = 0; k < BvhNode::width; ++k) {
        const Bounds box = k < count ? children[k].box : Bounds{};
        BvhNode &node = hierarchy_.nodes[own];
        const float lower[3] = {box.lower.x, box.lower.y, box.lower.z}, upper[3] = {box.upper.x, box.upper.y, box.upper.z};
        for (int axis = 0; axis < 3; ++axis) {
          const float centre = k < count ? 0.5f * lower[axis] + 0.5f * upper[axis] : 0.0f;
          node.centre[axis][k] = centre;
          node.half[axis][k] = k < count ? half_extent(centre, lower[axis], upper[axis]) : -infinity;
        }
        if (k >= count) {
          node.child[k] = BvhNode::leaf;
        } else if (count_of(children[k].entry) <= std::uint32_t(TrianglePacket::width)) {
          node.child[k] = BvhNode::leaf | std::uint32_t(hierarchy_.packets.size());
          hierarchy_.packets.push_back(packet_of(first_of(children[k].entry), count_of(children[k].entry)));
        } else {
          stack.push_back({children[k].entry, own, k});
        }
      }
    }
  }

private:
  struct Child {
    std::uint32_t entry;
    Bounds box;
  };

  std::uint32_t first_of(std::uint32_t entry) const {
    return (entry & BinaryNode::leaf) != 0 ? entry & ~BinaryNode::leaf : first_[entry];
  }
  std::uint32_t count_of(std::uint32_t entry) const { return (entry & BinaryNode::leaf) != 0 ? 1 : count_[entry]; }

  Child child_of(std::uint32_t binary, int side) const {
    const BinaryNode &node = hierarchy_.binary[binary];
    return {node.child[side], {node.lower[side], node.upper[side]}};
  }

  static Bounds both(const Bounds &a, const Bounds &b) {
    return {{std::min(a.lower.x, b.lower.x), std::min(a.lower.y, b.lower.y), std::min(a.lower.z, b.lower.z)},
            {std::max(a.upper.x, b.upper.x), std::max(a.upper.y, b.upper.y), std::max(a.upper.z, b.upper.z)}};
  }

  // The children of the node that stands for a binary node: of those that hold more than a packet, the nearest to the root is opened.
  int collect(std::uint32_t binary, Child *children) const {
    int count = 2;
    children[0] = child_of(binary, 0);
    children[1] = child_of(binary, 1);
    if (!(children[1].box.lower.x <= children[1].box.upper.x)) return 1;
    if (count_[binary] <= std::uint32_t(TrianglePacket::width)) { // the root alone
      children[0] = {binary, both(children[0].box, children[1].box)};
      return 1;
    }
    for (int next = 0; next < count && count < BvhNode::width;) {
      if (count_of(children[next].entry) <= std::uint32_t(TrianglePacket::width)) {
        ++next;
        continue;
      }
      const std::uint32_t opened = children[next].entry;
      for (int k = next; k + 1 < count; ++k) children[k] = children[k + 1];
      children[count - 1] = child_of(opened, 0);
      children[count++] = child_of(opened, 1);
    }
    return count;
  }

  TrianglePacket packet_of(std::uint32_t first, std::uint32_t count) const {
    TrianglePacket packet;
    packet.first = first;
    packet.count = count;
    for (std::uint32_t k = 0; k < std::uint32_t(TrianglePacket::width); ++k) {
      const BvhTriangle &t = hierarchy_.triangles[first + (k < count ? k : 0)];
      const auto set = [k](float(&lanes)[3][TrianglePacket::width], Vec3<float> v) {
        lanes[0][k] = v.x;
        lanes[1][k] = v.y;
        lanes[2][k] = v.z;
      };
      set(packet.a, t.a);
      set(packet.b, t.b);
      set(packet.c, t.c);
      set(packet.normal, t.normal);
    }
    return packet;
  }

  BoundingVolumeHierarchy &hierarchy_;
  std::vector<std::uint32_t> first_, count_; // of a binary node's triangles
};

} // namespace

void build_query_tree(BoundingVolumeHierarchy &hierarchy) { QueryTree(hierarchy).build(); }

} // namespace loam
