#include "host/ops/HostScores.h"

#include "host/loop/HostClients.h"
#include "host/rooms/HostContext.h"

namespace naiad {

HostScores::HostScores(const HostAccess& access) : m_access(access) {
  access.clients.rooms().setScores(*this);
}

void HostScores::begin() {
  of(m_access.context.game);
  const RoomManager& rooms = m_access.clients.rooms();
  if (rooms.isNamed()) rooms.forEachRoom([this](const Room& room) { of(room.plan()->game); });
}

ScoreKeeper& HostScores::of(const std::string& game) {
  auto& keeper = m_keepers[game];
  if (keeper == nullptr) {
    keeper = std::make_unique<ScoreKeeper>(m_access.context.options.state, game);
    keeper->setObserver([this, game](const ScoreRow& row) {
      if (m_observer) m_observer(row, game);
    });
  }
  return *keeper;
}

void HostScores::add(const std::string& game, const RoundName& round,
                     const std::vector<df::AddedScore>& scores) {
  if (!scores.empty()) of(game).add(round.id, scores, round.file);
}

void HostScores::tick(Clock::time_point) {
  ScoreCounters sum;
  for (const auto& [game, keeper] : m_keepers) {
    const ScoreCounters counters = keeper->counters();
    sum.added += counters.added;
    sum.refused += counters.refused;
    sum.written += counters.written;
    sum.dropped += counters.dropped;
    if (const std::string news = keeper->popLogMessage(); !news.empty())
      m_access.context.log(workerLogEvent(news));
  }
  m_access.context.counters.scores = sum.added;
  m_access.context.counters.scores_refused = sum.refused;
  m_access.context.counters.scores_written = sum.written;
  m_access.context.counters.scores_dropped = sum.dropped;
}

void HostScores::finish() {
  for (const auto& [game, keeper] : m_keepers) keeper->finish();
  tick(Clock::now());
}

}  // namespace naiad
