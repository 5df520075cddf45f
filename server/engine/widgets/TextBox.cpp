#include "engine/widgets/TextBox.h"

#include <algorithm>
#include <cmath>

#include "engine/managers/DisplayManager.h"
#include "engine/world/Geometry.h"

namespace df {

TextBox::TextBox() {
  Object::setType("TextBox");
  ViewObject::setDrawValue(false);
}

void TextBox::setSize(Vector new_size) {
  if (!(new_size.x() >= 1 && new_size.x() <= 400 && new_size.y() >= 1 && new_size.y() <= 150)) return;
  m_size = Vector(std::floor(new_size.x()), std::floor(new_size.y()));
}

std::vector<std::string> TextBox::lines() const {
  const auto inner = static_cast<std::size_t>(std::max(1.0, m_size.x() - (m_padding ? 2 : 0)));
  std::vector<std::string> out;
  for (std::size_t begin = 0; begin < m_text.size();) {
    const std::size_t end = std::min(m_text.find('\n', begin), m_text.size());
    std::string line = m_text.substr(begin, end - begin);
    begin = end + 1;
    while (line.size() > inner) {
      const std::size_t gap = m_word_wrap ? line.rfind(' ', inner) : std::string::npos;
      const bool breaks = gap != std::string::npos && gap > 0;
      out.push_back(line.substr(0, breaks ? gap : inner));
      line.erase(0, breaks ? gap + 1 : inner);
    }
    out.push_back(line);
  }
  return out;
}

int TextBox::draw() {
  const int width = static_cast<int>(m_size.x());
  const int height = static_cast<int>(m_size.y());
  const Vector corner =
      viewToWorld(getPosition()) - Vector(std::floor(width / 2.0), std::floor(height / 2.0));
  const std::vector<std::string> all = lines();
  const std::size_t first = all.size() - std::min(all.size(), static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    const std::size_t i = first + static_cast<std::size_t>(y);
    std::string row = i < all.size() ? (m_padding ? " " : "") + all[i] : "";
    row.resize(static_cast<std::size_t>(width), ' ');
    if (getBorder()) {
      row.insert(row.begin(), 1, '|');
      row.push_back('|');
    }
    DM.drawString(corner + Vector(getBorder() ? -1 : 0, y), row, LEFT_JUSTIFIED, getColor());
  }
  if (!getBorder()) return 0;
  std::string bar(static_cast<std::size_t>(width) + 2, '-');
  bar.front() = bar.back() = '+';
  DM.drawString(corner + Vector(-1, -1), bar, LEFT_JUSTIFIED, getColor());
  return DM.drawString(corner + Vector(-1, height), bar, LEFT_JUSTIFIED, getColor());
}

}  // namespace df
