// The shapes of a SubstepWorld's bodies. Bodies with equal shapes share them if they are added soon after
// each other, so that a step reads the shape of one crate for a whole heap.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/geometry/ConvexShape.h"

namespace naiad::physics {

struct SubstepForm {
  std::vector<ConvexShape> shapes;
  double reach = 0;         ///< maximum distance of a point of the shapes from the centre
  double thickness = 0;     ///< smallest half width of a shape
  std::size_t corners = 0;  ///< number of entries for all shapes in the output of turn()
  int users = 0;
};

class SubstepForms {
 public:
  /// Returns the number of these shapes in this store; call giveBack() when a body no longer uses them.
  std::int32_t take(std::span<const ConvexShape> shapes);
  void giveBack(std::int32_t form);
  const SubstepForm& operator[](std::int32_t form) const { return m_forms[static_cast<std::size_t>(form)]; }

 private:
  bool has(std::int32_t form, std::span<const ConvexShape> shapes) const;

  std::vector<SubstepForm> m_forms;
  std::vector<std::int32_t> m_free;
  std::array<std::int32_t, 4> m_recent = {-1, -1, -1, -1};  // the last forms made; only these are shared
  std::size_t m_next_recent = 0;
};

}  // namespace naiad::physics
