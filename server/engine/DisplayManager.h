// Puts characters on the screen (book, Listing 4.69).
//
// There is no screen here: characters are collected, in world coordinates, and shown to each player by the
// client. Call these from an Object's draw(). What is drawn elsewhere in a tick is shown for that tick,
// below everything else.
#pragma once

#include <string>

#include "Color.h"
#include "Manager.h"
#include "Vector.h"

#define DM df::DisplayManager::getInstance()

namespace df {

/// Size of the window, in cells, unless DM.setSize() says otherwise.
inline constexpr int WINDOW_HORIZONTAL_CHARS_DEFAULT = 80;
inline constexpr int WINDOW_VERTICAL_CHARS_DEFAULT = 24;

/// Where a string lies relative to its position.
enum Justification {
  LEFT_JUSTIFIED,    ///< it begins there
  CENTER_JUSTIFIED,  ///< its middle is there
  RIGHT_JUSTIFIED,   ///< it ends just before
};

class DisplayManager : public Manager {
 public:
  static DisplayManager& getInstance();

  int startUp() override;
  void shutDown() override;
  bool isStarted() const override;

  /// One character at a world position, in the cell floor(v + 0.5). A character that terminals do not draw
  /// in exactly one cell becomes '?'. Return 0, or -1 for a position or colour out of range.
  int drawCh(Vector world_pos, char ch, Color color = COLOR_DEFAULT) const;
  int drawCh(Vector world_pos, char32_t ch, Color color = COLOR_DEFAULT) const;
  /// A UTF-8 string, one character per cell. Return 0, or -1 as above, with nothing drawn.
  int drawString(Vector world_pos, const std::string& str, Justification just = LEFT_JUSTIFIED,
                 Color color = COLOR_DEFAULT) const;

  /// Size of the window, and so of every view, in cells: 20 to 400 by 10 to 150; before GM.run(). A
  /// boundary that was never set follows. Return 0, else -1.
  int setSize(int horizontal, int vertical);
  int getHorizontal() const;
  int getVertical() const;

 private:
  DisplayManager() { setType("DisplayManager"); }
};

}  // namespace df
