#include "physics/soft/SoftCrowd.h"

#include <algorithm>
#include <tuple>

namespace naiad::physics {

namespace {

Vec2 middleOf(const SoftView& view) {
  return 0.5 * (view.lower + view.upper);
}

}  // namespace

void SoftCrowd::gather(const std::vector<SoftView>& views, std::size_t which) {
  const SoftView& view = views[which];
  m_others.clear();
  std::size_t before = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (i == which || !mayMeet(view, views[i])) continue;
    const Vec2 offset = (views[i].body->place - view.body->place) + (middleOf(views[i]) - middleOf(view));
    before += i < which ? 1 : 0;
    m_others.push_back({i, lengthSquared(offset), m_others.size()});
  }
  for (Other& other : m_others) {
    other.turn = other.turn < before ? other.turn + m_others.size() - before : other.turn - before;
  }
}

bool SoftCrowd::findContacts(const std::vector<SoftView>& views, std::size_t which,
                             std::vector<SoftRow>& rows) {
  const SoftView& view = views[which];
  gather(views, which);
  const std::size_t most = std::max<std::size_t>(kMaxOthers, view.body->boundary.size() / 2);
  const bool is_crowded = m_others.size() > most;
  if (is_crowded) {
    const auto isNearer = [](const Other& a, const Other& b) {
      return std::tie(a.square, a.turn) < std::tie(b.square, b.turn);
    };
    std::sort(m_others.begin(), m_others.end(), isNearer);
    m_others.resize(most);
  }
  const std::size_t begin = rows.size();
  for (const Other& other : m_others) physics::findContacts(view, views[other.index], rows);
  if (!is_crowded || rows.size() - begin <= most) return !is_crowded;
  const auto turn = [&](const SoftRow& row) { return static_cast<unsigned>(row.b.body - view.id); };
  const auto isDeeper = [&](const SoftRow& a, const SoftRow& b) {
    return std::tuple(a.gaps[0], turn(a), a.a.nodes[0]) < std::tuple(b.gaps[0], turn(b), b.a.nodes[0]);
  };
  std::sort(rows.begin() + static_cast<std::ptrdiff_t>(begin), rows.end(), isDeeper);
  rows.resize(begin + most);
  return false;
}

}  // namespace naiad::physics
