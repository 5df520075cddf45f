// Puts characters on the screen (book, Listing 4.69).
//
// The engine has no screen of its own: characters are collected in world coordinates, and each player's
// client shows them. Call these functions from an Object's draw(). Characters drawn elsewhere in a tick are
// shown for that tick, below everything else.
#pragma once

#include <string>

#include "Color.h"
#include "Config.h"
#include "Frame.h"
#include "Manager.h"
#include "Sfml.h"
#include "StandardHeaders.h"
#include "Vector.h"

/// The display manager.
#define DM df::DisplayManager::getInstance()

namespace df {

/// Alignment of a string to its position.
enum Justification {
  LEFT_JUSTIFIED,    ///< the string begins at the position
  CENTER_JUSTIFIED,  ///< the middle of the string is at the position
  RIGHT_JUSTIFIED,   ///< the string ends just before the position
};

/// Size of the published engine's window, in pixels. Naiad does not use it.
inline constexpr int WINDOW_HORIZONTAL_PIXELS_DEFAULT = 1024;
inline constexpr int WINDOW_VERTICAL_PIXELS_DEFAULT = 768;
/// A title bar and a close button, as bits of the graphics library SFML.
inline constexpr int WINDOW_STYLE_DEFAULT = 5;
inline constexpr Color WINDOW_BACKGROUND_COLOR_DEFAULT = BLACK;
const std::string WINDOW_TITLE_DEFAULT = "Dragonfly";
const std::string FONT_FILE_DEFAULT = "df-font.ttf";
inline constexpr float FONT_SCALE_DEFAULT = 2;

/// Returns the size of a character, in pixels of the window that the published engine would open.
float charHeight();
float charWidth();
/// Convert a vector from cells to pixels of that window, and back.
Vector spacesToPixels(Vector spaces);
Vector pixelsToSpaces(Vector pixels);

class DisplayManager : public Manager {
 public:
  /// Returns the only instance; DM is short for it. It acts on the current world.
  static DisplayManager& getInstance();

  /// Draws one character at a world position, in the cell floor(v + 0.5). A character that terminals do not
  /// draw in exactly one cell becomes '?'. Returns 0, or -1 for a position or colour out of range.
  int drawCh(Vector world_pos, char ch, Color color = COLOR_DEFAULT) const;
  int drawCh(Vector world_pos, char32_t ch, Color color = COLOR_DEFAULT) const;
  /// Draws the character with the ASCII code `ch`, for example `'0' + digit`; '?' for other numbers.
  int drawCh(Vector world_pos, int ch, Color color = COLOR_DEFAULT) const;
  /// Like drawCh(world_pos, ch, color): ignores the rotation, because terminals do not turn characters.
  int drawCh(Vector world_pos, char ch, Color color, float rotation) const;
  /// Draws in the terminal colour, one of eight, that is nearest to this mix of red, green and blue.
  int drawCh(Vector world_pos, char ch, unsigned char r, unsigned char g, unsigned char b,
             float rotation = 0) const;
  /// Draws a UTF-8 string, one character per cell. Returns 0, or -1 with no effect if drawCh() would do so.
  int drawString(Vector world_pos, const std::string& str, Justification just = LEFT_JUSTIFIED,
                 Color color = COLOR_DEFAULT) const;
  /// Draws a frame, as published engines up to 4.20 name it (newer ones: Frame::draw()). `world_pos` is the
  /// frame's centre if `centered`, else its top left character. Returns what Frame::draw() returns.
  int drawFrame(Vector world_pos, const Frame& frame, bool centered, Color color = COLOR_DEFAULT,
                char transparent = 0) const {
    const Vector half((frame.getWidth() - 1) / 2.0f, (frame.getHeight() - 1) / 2.0f);
    return frame.draw(centered ? world_pos : world_pos + half, color, transparent);
  }

  /// Size of the window, and so of every view, in cells: 20 to 400 by 10 to 150. Set it before GM.run(). A
  /// boundary that was never set gets this size, too. setSize() returns 0, or -1 for a size out of range.
  int setSize(int horizontal, int vertical);
  int getHorizontal() const;
  int getVertical() const;
  void setHorizontal(int new_horizontal) { setSize(new_horizontal, getVertical()); }
  void setVertical(int new_vertical) { setSize(getHorizontal(), new_vertical); }

  /// Returns the size of the window that the published engine would open, in pixels.
  int getHorizontalPixels() const;
  int getVerticalPixels() const;

  /// Sets the colour behind all characters, for all players; BLACK means each terminal's own background.
  /// Returns true, or false for an unknown colour.
  bool setBackgroundColor(Color new_color);
  /// Shakes the picture for `duration` ticks by up to `scale_x` and `scale_y` pixels. If `delta`, these are
  /// added to the present shake. The picture moves by whole cells of about 13 by 32 pixels, so a scale above
  /// 0 counts as at least one cell, and at most 20; view objects do not move.
  void shake(int scale_x, int scale_y, int duration, bool delta = false);
  /// Does nothing, because characters are shown at the end of the tick. Returns 0.
  int swapBuffers() { return 0; }
  /// Returns a stand-in for the published engine's window: calls on it do nothing.
  sf::RenderWindow* getWindow() const;

 private:
  DisplayManager();
};

}  // namespace df
