#include "host/snapshot/InterestGrid.h"

namespace naiad {

void InterestGrid::put(std::uint32_t slot, CellPosition cell) {
  if (slot >= m_places.size()) m_places.resize(std::size_t{slot} + 1);
  const std::uint64_t key = keyOf(cell.x >> kColumnShift, cell.y >> kRowShift);
  if (m_places[slot].filed && m_places[slot].key == key) return;
  remove(slot);
  Block& block = m_blocks[key];
  if (block.empty()) foundOf(key).valid = false;
  m_places[slot] = {key, static_cast<std::uint32_t>(block.size()), true};
  block.push_back(slot);
}

void InterestGrid::remove(std::uint32_t slot) {
  if (slot >= m_places.size() || !m_places[slot].filed) return;
  const Place place = m_places[slot];
  const auto found = m_blocks.find(place.key);
  Block& block = found->second;
  block[place.index] = block.back();
  m_places[block.back()].index = place.index;
  block.pop_back();
  if (block.empty()) {
    foundOf(place.key).valid = false;
    m_blocks.erase(found);
  }
  m_places[slot].filed = false;
}

}  // namespace naiad
