// The tree that contact queries walk, made from the binary tree: two levels of that are one, four children a node, and whatever holds four
// triangles or fewer is a packet. The boxes of a node and the triangles of a packet lie side by side, for vector code.
#pragma once

#include "scene/bounding_volume_hierarchy.h"

namespace loam {

// Fills nodes and packets.
void build_query_tree(BoundingVolumeHierarchy &hierarchy);

} // namespace loam
