#include "physics/body/BodyTable.h"

#include <algorithm>
#include <utility>

namespace naiad::physics {

const BodyMedium BodyTable::kNoMedium;
const BodyGeometry BodyTable::kNoForm;

BodyTable::Index BodyTable::add(const Object* p_object, ObjectKey key) {
  Index index = 0;
  if (m_free.empty()) {
    index = static_cast<Index>(m_rows.size());
    m_rows.emplace_back();
  } else {
    index = m_free.back();
    m_free.pop_back();
    m_rows[index] = {};
    if (index < m_media.size()) m_media[index] = {};
    if (index < m_forms.size()) m_forms[index] = {};
  }
  BodyRow& row = m_rows[index];
  row.key = key;
  row.p_object = p_object;
  row.order = m_next_order++;
  row.used = true;
  m_order.push_back(index);
  return index;
}

void BodyTable::remove(Index index) {
  m_rows[index].used = false;
  joints.removeOf(static_cast<int>(index));
  const auto place =
      std::lower_bound(m_order.begin(), m_order.end(), m_rows[index].order,
                       [this](Index other, std::uint64_t order) { return m_rows[other].order < order; });
  m_order.erase(place);
  m_free.push_back(index);
}

BodyMedium& BodyTable::medium(Index index) {
  if (index >= m_media.size()) m_media.resize(index + 1);
  return m_media[index];
}

BodyGeometry& BodyTable::form(Index index) {
  if (index >= m_forms.size()) m_forms.resize(index + 1);
  return m_forms[index];
}

double BodyTable::unitInertia(Index index, const FixedBox& box) const {
  const BodyGeometry& its = form(index);
  if (!its.shapes.empty()) return its.unit_inertia;
  return lengthSquared(metric.fromCells(Vector::fromFixed(box.size))) / 12;
}

void BodyTable::syncFromStore(Index index, FixedVector position, FixedVector velocity) {
  BodyRow& row = m_rows[index];
  if (position != row.published_position) {
    row.place = metric.placeOf(position);
    row.published_position = position;
    row.frozen = false;
  }
  if (velocity != row.published_velocity) {
    row.velocity = metric.fromCells(Vector::fromFixed(velocity));
    row.published_velocity = velocity;
    row.frozen = false;
  }
}

void BodyTable::classify(Index index) {
  const BodyMedium& medium = std::as_const(*this).medium(index);
  FlightKind& kind = m_rows[index].flight;
  const bool springs = medium.spring.stiffness > 0 || medium.spring.damping > 0;
  if (medium.field != nullptr || (springs && medium.quadratic_drag > 0)) {
    kind = FlightKind::kField;
  } else if (springs) {
    kind = FlightKind::kSpring;
  } else if (medium.quadratic_drag > 0) {
    kind = medium.linear_drag > 0 ? FlightKind::kField : FlightKind::kQuadraticDrag;
  } else {
    kind = medium.linear_drag > 0 ? FlightKind::kLinearDrag : FlightKind::kFree;
  }
}

}  // namespace naiad::physics
