// Union, intersection, difference and complement of shapes.
#pragma once

#include <vector>

#include "coupling/shared/signed_distance.hpp"

namespace gasgrain {

// Solid where any (union) or every (intersection) part is; at least one part.
Shape make_union(std::vector<Shape> parts);
Shape make_intersection(std::vector<Shape> parts);
// Solid where `base` is and `removed` is not.
Shape make_difference(Shape base, Shape removed);
// Solid where `shape` is not: the wall of a vessel from its interior.
Shape make_complement(Shape shape);

}  // namespace gasgrain
