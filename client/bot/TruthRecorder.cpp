#include "client/bot/TruthRecorder.h"

#include "shared/replica/Look.h"
#include "shared/replica/TruthFile.h"

namespace naiad {

void TruthRecorder::beforeSnapshot(const Replica& replica, std::uint32_t tick) {
  if (m_started && !isNewer(tick, m_tick)) return;
  if (m_started && m_complete) {
    const std::uint32_t end = m_skips ? m_tick + 1 : tick;
    for (; m_tick != end && !m_full; ++m_tick) record(replica, m_tick);
  }
  m_tick = tick;
  m_started = true;
}

void TruthRecorder::afterSnapshot(const SnapshotHeader& header, const AckWindow& acks, bool skips,
                                  std::uint32_t before) {
  m_tracker.addSnapshot(header, acks, before);
  if (header.tick != m_tick) return;
  m_complete = m_tracker.isComplete();
  m_skips = skips;
}

void TruthRecorder::finish(const Replica& replica) {
  if (m_started && m_complete) record(replica, m_tick);
  m_started = false;
}

void TruthRecorder::record(const Replica& replica, std::uint32_t tick) {
  df::Canvas picture = replica.render(tick);
  m_cells += static_cast<std::size_t>(picture.width()) * static_cast<std::size_t>(picture.height());
  m_full = m_pictures.size() >= kMaxTicks || m_cells > m_max_cells;
  if (m_full) return;
  m_pictures[tick] = std::move(picture);
  for (const auto& [id, entry] : replica.entries()) {
    if (!entry.alive) continue;
    const CellPosition cell = glyphCell(positionAt(entry.state.motion, tick), Glyph{});
    const auto [found, fresh] = m_tracks.try_emplace(id, Track{entry.generation, cell, false});
    Track& track = found->second;
    if (!fresh && track.generation != entry.generation) {
      m_removed_moved += track.moved ? 1 : 0;
      track = {entry.generation, cell, false};
    }
    if (!(track.first == cell)) track.moved = true;
  }
}

std::size_t TruthRecorder::movingCount() const {
  std::size_t count = m_removed_moved;
  for (const auto& [slot, track] : m_tracks) count += track.moved ? 1 : 0;
  return count;
}

TruthRecorder::Comparison& TruthRecorder::Comparison::operator+=(const Comparison& other) {
  readable = readable && other.readable;
  ticks += other.ticks;
  cells += other.cells;
  wrong += other.wrong;
  if (first_wrong_tick == 0) first_wrong_tick = other.first_wrong_tick;
  return *this;
}

TruthRecorder::Comparison TruthRecorder::compare(const std::string& path, std::uint32_t player) const {
  Comparison result;
  TruthReader reader(path);
  if (!reader.isOpen()) return result;
  while (const auto truth = reader.next()) {
    const auto seen = truth->player == player ? m_pictures.find(truth->tick) : m_pictures.end();
    if (seen == m_pictures.end()) continue;
    const int wrong = countDifferences(seen->second, truth->canvas);
    ++result.ticks;
    result.cells += static_cast<std::uint64_t>(truth->canvas.width()) *
                    static_cast<std::uint64_t>(truth->canvas.height());
    result.wrong += static_cast<std::uint64_t>(wrong);
    if (wrong > 0 && result.first_wrong_tick == 0) result.first_wrong_tick = truth->tick;
  }
  result.readable = !reader.isMalformed();
  return result;
}

}  // namespace naiad
