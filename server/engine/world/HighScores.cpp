#include "engine/world/HighScores.h"

#include <algorithm>
#include <cstddef>

#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"

namespace df {

int HighScores::add(const std::string& name, std::int64_t points) {
  World& world = World::current();
  if (world.extras().scores.add(m_table, name, points)) return 0;
  return world.log().refuse("HighScores", "add");
}

std::vector<HighScore> HighScores::best(int count) const {
  const WorldExtras* p_extras = World::current().findExtras();
  if (p_extras == nullptr || count <= 0) return {};
  const std::vector<HighScore>& rows = p_extras->scores.rows(m_table);
  const std::size_t most = std::min(rows.size(), static_cast<std::size_t>(count));
  return {rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(most)};
}

}  // namespace df
