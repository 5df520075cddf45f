// The shapes of a SubstepWorld's bodies. Bodies of the same shapes share them: of a heap of crates each step
// reads one crate, not as many as there are.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/geometry/ConvexShape.h"

namespace naiad::physics {

struct SubstepForm {
  std::vector<ConvexShape> shapes;
  double reach = 0;         ///< of all shapes, from the centre
  double thickness = 0;     ///< the least half width of a shape
  std::size_t corners = 0;  ///< of all shapes, as turn() writes them
  int users = 0;
};

class SubstepForms {
 public:
  /// Returns its number, to be given back.
  std::int32_t take(std::span<const ConvexShape> shapes);
  void giveBack(std::int32_t form);
  const SubstepForm& operator[](std::int32_t form) const { return m_forms[static_cast<std::size_t>(form)]; }

 private:
  bool has(std::int32_t form, std::span<const ConvexShape> shapes) const;

  std::vector<SubstepForm> m_forms;
  std::vector<std::int32_t> m_free;
  std::array<std::int32_t, 4> m_recent = {-1, -1, -1, -1};  // the ones that are looked through
  std::size_t m_next_recent = 0;
};

}  // namespace naiad::physics
