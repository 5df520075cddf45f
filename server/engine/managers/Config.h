// The settings of a game: what df-config.txt says, or the defaults.
//
//     # a comment
//     window_horizontal_chars:100,
//     random_seed:7,
//
// GM.startUp() reads the file, from the working directory, or the one that the environment names
// (DRAGONFLY_CONFIG). These count: size in characters and background of the window, random_seed, compat,
// logfile; in a host frame_time; in a program headless and the host's options. The rest is kept and has no
// effect.
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
  /// The current world's.
  static Config& getInstance();

  // Of each setting a getter and a setter, as getFrameTime() and setFrameTime(33). Setters count before
  // GM.startUp() opens the window; those of its size in characters and of its background always (DM.setSize).
/// A setting with its getter and setter.
#define DF_SETTING(Type, Name, member)     \
  Type get##Name() const {                 \
    return settings().member;              \
  }                                        \
  void set##Name(Type member) {            \
    settings().member = std::move(member); \
  }
/// The same, of the window: it takes effect at once.
#define DF_WINDOW_SETTING(Type, Name, member) \
  Type get##Name() const {                    \
    return settings().member;                 \
  }                                           \
  void set##Name(Type member) {               \
    settings().member = member;               \
    applyWindow();                            \
  }
  // clang-format off
  /// Settings as df-config.txt names them (its comments above say which have an effect).
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
  /// As `headless:true,` does: no network, and ticks as fast as they go.
  void setHeadless() {
    setHeadless(true);
  }
  /// Kept, and without effect: terminals show their pointer.
  void setShowMouse() {
    setShowMouse(true);
  }

  /// The value of a key in what was read; empty if there is none.
  std::string match(const std::string& find) const;

  /// Write all of it to the log.
  void writeToLog() const;
  /// What the file says, without comments; empty if there is none.
  std::string readConfig();
  /// Take on what `str` says, or the file, if it is empty. What a line says wrongly is logged and left out.
  void loadConfig(const std::string& str = "");

 private:
  Config() = default;
  static ConfigSettings& settings();
  static void applyWindow();
};

}  // namespace df
