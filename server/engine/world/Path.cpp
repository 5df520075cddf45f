#include "engine/world/Path.h"

#include "engine/world/Drawing.h"

namespace df {

namespace {

Vector nodeAt(const std::vector<Vector>& nodes, int index) {
  if (index < 0 || index >= static_cast<int>(nodes.size())) return {-1, -1};
  return nodes[static_cast<std::size_t>(index)];
}

}  // namespace

Vector Path::nextNode() const {
  return nodeAt(m_path, m_index);
}

Vector Path::previousNode() const {
  return nodeAt(m_path, m_index - 1);
}

Vector Path::getEnd() const {
  return nodeAt(m_path, static_cast<int>(m_path.size()) - 1);
}

void Path::setPath(std::vector<Vector> new_path) {
  m_path = std::move(new_path);
  m_index = 0;
}

int Path::setIndex(int new_index) {
  if (new_index < 0 || new_index >= static_cast<int>(m_path.size())) return -1;
  m_index = new_index;
  return 0;
}

Path Path::operator++(int) {
  Path before = *this;
  if (!endOfPath()) ++m_index;
  return before;
}

int Path::draw(Color color) const {
  int result = 0;
  for (std::size_t i = static_cast<std::size_t>(m_index); i < m_path.size(); ++i) {
    if (drawCharacter(m_path[i], '.', color) != 0) result = -1;
  }
  return result;
}

std::string Path::toString() const {
  std::string text;
  for (const Vector& node : m_path) text += node.toString();
  return text;
}

}  // namespace df
