// The settings of a game, from df-config.txt or the defaults.
//
//     # a comment
//     window_horizontal_chars:100,
//     random_seed:7,
//
// GM.startUp() reads the file from the working directory, or the one that the environment names
// (DRAGONFLY_CONFIG). These settings have an effect: size in characters and background of the window,
// random_seed, compat, logfile; in a host frame_time; in a program headless and the host's options. The rest
// is only stored.
#pragma once

#include <string>
#include <utility>

#include "Color.h"
#include "StandardHeaders.h"
#include "detail/Settings.h"

#if !defined(DF_DEPRECATED)
/// Marks older names.
#define DF_DEPRECATED __attribute__((deprecated))
#endif

namespace df {

/// The file that GM.startUp() reads.
const std::string CONFIG_FILENAME = "df-config.txt";

class Config {
 public:
  /// Returns the settings of the current world.
  static Config& getInstance();

  // Each setting has a getter and a setter, such as getFrameTime() and setFrameTime(33). Setters act until
  // GM.startUp() opens the window; those of its size in characters and background always (DM.setSize).
/// A setting with its getter and setter.
#define DF_SETTING(Type, Name, member)     \
  Type get##Name() const {                 \
    return settings().member;              \
  }                                        \
  void set##Name(Type member) {            \
    settings().member = std::move(member); \
  }
/// A setting of the window, whose setter takes effect at once.
#define DF_WINDOW_SETTING(Type, Name, member) \
  Type get##Name() const {                    \
    return settings().member;                 \
  }                                           \
  void set##Name(Type member) {               \
    settings().member = member;               \
    applyWindow();                            \
  }
  // clang-format off
  /// Settings as df-config.txt names them (the top of this file says which have an effect).
  DF_SETTING(std::string, Config, text)
  DF_SETTING(int, WindowHorizontalPixels, window_horizontal_pixels)
  DF_SETTING(int, WindowVerticalPixels, window_vertical_pixels)
  DF_WINDOW_SETTING(int, WindowHorizontalChars, window_horizontal_chars)
  DF_WINDOW_SETTING(int, WindowVerticalChars, window_vertical_chars)
  DF_WINDOW_SETTING(Color, WindowBackgroundColor, window_background_color)
  DF_SETTING(int, WindowStyle, window_style)
  DF_SETTING(std::string, WindowTitle, window_title)
  DF_SETTING(int, FrameTime, frame_time)
  DF_SETTING(float, FontScale, font_scale)
  DF_SETTING(std::string, FontFile, font_file)
  DF_SETTING(bool, ShowMouse, show_mouse)
  DF_SETTING(int, WindowState, window_state)
  DF_SETTING(bool, Signals, signals)
  DF_SETTING(bool, Headless, headless)
  DF_SETTING(std::string, LogFile, logfile)
  DF_SETTING(int, RandomSeed, random_seed)
  DF_SETTING(bool, Networking, networking)
  DF_SETTING(int, QuadtreeDepth, quadtree_depth)
  DF_SETTING(int, QuadtreeThreshold, quadtree_threshold)
  DF_SETTING(int, GridWidth, grid_width)
  DF_SETTING(int, GridHeight, grid_height)
  // clang-format on
#undef DF_SETTING
#undef DF_WINDOW_SETTING
  /// Like `headless:true,`: no network, and ticks as fast as possible.
  void setHeadless() {
    setHeadless(true);
  }
  /// Stored, without effect: terminals show their pointer.
  void setShowMouse() {
    setShowMouse(true);
  }

  /// Returns the value of a key in the text that was read; empty if it is missing.
  std::string match(const std::string& find) const;

  /// Writes the main settings to the log.
  void writeToLog() const;
  /// Returns the contents of the file, without comments; empty if it is missing.
  std::string readConfig();
  /// Sets what `str` says, or the file, if `str` is empty. Invalid values are logged and ignored.
  void loadConfig(const std::string& str = "");

 private:
  Config() = default;
  static ConfigSettings& settings();
  static void applyWindow();
};

}  // namespace df
