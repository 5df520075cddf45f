// The settings of a game, from df-config.txt or the defaults.
//
//     # a comment
//     window_horizontal_chars:100,
//     random_seed:7,
//
// GM.startUp() reads the file in the working directory, or the one that the environment variable
// DRAGONFLY_CONFIG names. These settings have an effect: size in characters and background of the window,
// random_seed, compat, logfile; frame_time if a host runs the game; headless and the host's options if the
// game is a program of its own. All other settings are only stored.
#pragma once

#include <string>
#include <utility>

#include "Color.h"
#include "StandardHeaders.h"
#include "detail/Settings.h"

#if !defined(DF_DEPRECATED)
/// Marks functions that games should no longer call.
#define DF_DEPRECATED __attribute__((deprecated))
#endif

namespace df {

/// Name of the file that GM.startUp() reads.
const std::string CONFIG_FILENAME = "df-config.txt";

class Config {
 public:
  /// Returns the settings of the current world.
  static Config& getInstance();

  // Each setting has a getter and a setter, such as getFrameTime() and setFrameTime(33). Call setters before
  // GM.startUp(); only those of the window's size in characters and background also act later (DM.setSize).
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
  /// The settings of df-config.txt; the top of this file lists those that have an effect.
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
  /// Only stored, without effect, because terminals show their own pointer.
  void setShowMouse() {
    setShowMouse(true);
  }

  /// Logs the keys that were read and that neither loadConfig() nor match() has looked up, once each.
  static void reportUnknownKeys();
  /// Returns the value of the key `find` in the configuration that was read; empty if the key is missing.
  std::string match(const std::string& find) const;

  /// Writes the main settings to the log.
  void writeToLog() const;
  /// Reads the configuration file and returns its contents without comments; empty if the file is missing or
  /// is not a regular file.
  std::string readConfig();
  /// Applies the settings in the text `str` or, if it is empty, in the file. Logs and ignores invalid values.
  void loadConfig(const std::string& str = "");

 private:
  Config() = default;
  static ConfigSettings& settings();
  static void applyWindow();
};

}  // namespace df
