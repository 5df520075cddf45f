#include "physics/substep/SubstepForms.h"

#include <algorithm>

#include "physics/geometry/Index.h"

namespace naiad::physics {

bool SubstepForms::has(std::int32_t form, std::span<const ConvexShape> shapes) const {
  if (form < 0 || m_forms[at(form)].users == 0) return false;
  const std::vector<ConvexShape>& own = m_forms[at(form)].shapes;
  return std::equal(own.begin(), own.end(), shapes.begin(), shapes.end(), isEqual);
}

std::int32_t SubstepForms::take(std::span<const ConvexShape> shapes) {
  for (const std::int32_t recent : m_recent) {
    if (!has(recent, shapes)) continue;
    ++m_forms[at(recent)].users;
    return recent;
  }
  auto form = static_cast<std::int32_t>(m_forms.size());
  if (m_free.empty()) {
    m_forms.emplace_back();
  } else {
    form = m_free.back();
    m_free.pop_back();
  }
  SubstepForm& made = m_forms[at(form)];
  made = {};
  made.shapes.assign(shapes.begin(), shapes.end());
  made.thickness = shapes.empty() ? 0 : kMaxShapeExtent;
  made.users = 1;
  for (const ConvexShape& shape : shapes) {
    made.reach = std::max(made.reach, shape.reach + shape.radius);
    made.thickness = std::min(made.thickness, thicknessOf(shape));
    made.corners += 2 * at(shape.count);
  }
  m_recent[m_next_recent++ % m_recent.size()] = form;
  return form;
}

void SubstepForms::giveBack(std::int32_t form) {
  if (form >= 0 && --m_forms[at(form)].users == 0) m_free.push_back(form);
}

}  // namespace naiad::physics
