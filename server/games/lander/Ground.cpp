#include "Ground.h"

#include <algorithm>
#include <array>

#include "DisplayManager.h"
#include "WorldManager.h"

namespace {

constexpr int kHighest = 14;  // topmost row of the mountains
constexpr int kLowest = 22;
constexpr int kPadWidth = 8;
constexpr std::array<int, 4> kWorths = {50, 100, 200, 100};

}  // namespace

Ground::Ground(int x, int top, int worth) : m_worth(worth) {
  setType("Ground");
  setStaticLook();
  // The position is the uppermost cell; the box reaches from its upper edge to below the screen.
  setPosition(df::Vector(x, top));
  setBox(df::Box(df::Vector(-0.5, -0.5), 1, DM.getVertical() - top + 1));
}

int Ground::draw() {
  const df::Vector at = getPosition();
  DM.drawCh(at, m_worth > 0 ? '=' : '^', m_worth > 0 ? df::GREEN : df::YELLOW);
  for (int row = 1; at.y() + row < DM.getVertical(); ++row)
    DM.drawCh(at + df::Vector(0, row), ':', df::YELLOW);
  return 0;
}

void makeLandscape() {
  const int width = DM.getHorizontal();
  const int stretch = width / static_cast<int>(kWorths.size());  // width of the mountains with one pad
  int top = 18;
  for (int x = 0; x < width; ++x) {
    const int pad = x / stretch;
    const int within = x % stretch - (stretch - kPadWidth) / 2;
    const bool is_pad = pad < static_cast<int>(kWorths.size()) && within >= 0 && within < kPadWidth;
    if (!is_pad) top = std::clamp(top + WM.randomInt(7) - 3, kHighest, kLowest);
    new Ground(x, top, is_pad ? kWorths[static_cast<std::size_t>(pad)] : 0);
  }
}
