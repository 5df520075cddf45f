// The settings of one world as plain data, and their defaults. Config.h says where they come from.
#pragma once

#include <string>
#include <vector>

#include "Color.h"

namespace df {

/// Size of the window, in cells, unless DM.setSize() or df-config.txt says otherwise.
inline constexpr int WINDOW_HORIZONTAL_CHARS_DEFAULT = 80;
inline constexpr int WINDOW_VERTICAL_CHARS_DEFAULT = 24;

/// The file to which log lines are written.
const std::string LOGFILE_DEFAULT = "dragonfly.log";

/// Settings of one world.
struct ConfigSettings {
  std::string text;  ///< the configuration that was read: "key:value," without comments
  /// Known keys of the configuration: those of the engine, and all that Config::match() has looked up.
  std::vector<std::string> known_keys;
  int window_horizontal_pixels = 1024;
  int window_vertical_pixels = 768;
  int window_horizontal_chars = WINDOW_HORIZONTAL_CHARS_DEFAULT;
  int window_vertical_chars = WINDOW_VERTICAL_CHARS_DEFAULT;
  Color window_background_color = BLACK;
  int window_style = 5;
  int window_state = 0;  ///< 0: a window, 1: the whole screen
  bool signals = true;   ///< whether the engine catches signals
  std::string window_title = "Dragonfly";
  int frame_time = 33;  ///< length of a tick, in milliseconds
  float font_scale = 2;
  std::string font_file = "df-font.ttf";
  bool show_mouse = true;
  bool headless = false;
  std::string logfile = LOGFILE_DEFAULT;
  int random_seed = -1;  ///< 0: seed from the time; -1: not set
  bool networking = false;
  bool runs_empty = false;  ///< true: a host ticks the world even without players (WM.setRunsEmpty)
  int quadtree_threshold = 10;
  int quadtree_depth = 5;
  int grid_width = 1;
  int grid_height = 1;
};

}  // namespace df
