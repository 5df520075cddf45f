#include "server/replay/PictureReel.h"

#include <algorithm>

namespace naiad {

namespace {

std::size_t cellsOf(const std::vector<WorldPicture>& pictures) {
  std::size_t cells = 1;
  for (const WorldPicture& picture : pictures)
    cells +=
        static_cast<std::size_t>(picture.canvas.width()) * static_cast<std::size_t>(picture.canvas.height());
  return cells;
}

std::uint32_t countTurns(const RecordedRound& round) {
  const auto reader = round.read();
  std::uint32_t count = 0;
  while (const auto record = reader->next()) count += std::holds_alternative<WorldTurn>(*record) ? 1 : 0;
  return count;
}

}  // namespace

PictureReel::PictureReel(const RecordedRound& round, const RoundStage& stage)
    : m_round(round),
      m_stage(stage),
      m_replay(std::make_unique<Replay>(round, stage)),
      m_count(countTurns(round)) {}

const PictureReel::Frame* PictureReel::find(std::uint32_t tick) const {
  if (m_frames.empty() || tick < m_frames.front().tick || tick > m_frames.back().tick) return nullptr;
  return &m_frames[tick - m_frames.front().tick];
}

const std::vector<WorldPicture>& PictureReel::pictures() const {
  static const std::vector<WorldPicture> none;
  const Frame* p_frame = find(m_tick);
  return p_frame != nullptr ? p_frame->pictures : none;
}

std::uint32_t PictureReel::seek(std::uint32_t tick) {
  tick = std::max(tick, 1u);
  if (find(tick) == nullptr) executeTo(tick);
  if (find(tick) != nullptr) {
    m_tick = tick;
  } else if (!m_frames.empty()) {
    m_tick = m_frames.back().tick;
  }
  return m_tick;
}

void PictureReel::executeTo(std::uint32_t tick) {
  if (tick <= m_replay->tick()) {
    m_replay = std::make_unique<Replay>(m_round, m_stage);
    m_frames.clear();
    m_cells = 0;
  }
  while (m_replay->tick() < tick) {
    const bool wanted = m_replay->tick() + kLead >= tick || m_replay->tick() + kLead >= m_count;
    if (!m_replay->step(wanted)) return;
    if (wanted) keep();
  }
}

void PictureReel::keep() {
  if (!m_frames.empty() && m_frames.back().tick + 1 != m_replay->tick()) {
    m_frames.clear();
    m_cells = 0;
  }
  m_frames.push_back({m_replay->tick(), m_replay->pictures()});
  m_cells += cellsOf(m_frames.back().pictures);
  for (; m_cells > kMaxCells && m_frames.size() > 1; m_frames.pop_front())
    m_cells -= cellsOf(m_frames.front().pictures);
}

}  // namespace naiad
