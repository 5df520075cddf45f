// The settings of a game: what df-config.txt says, or the defaults.
//
//     # a comment
//     window_horizontal_chars:100,
//     random_seed:7,
//
// GM.startUp() reads the file, from the working directory, or the one that the environment names
// (DRAGONFLY_CONFIG). These count: size in characters and background of the window, random_seed, compat,
// logfile; in a host frame_time; in a program headless and the host's options. The rest is kept for who asks.
#pragma once

#include <string>

#include "Color.h"
#include "StandardHeaders.h"
#include "detail/Settings.h"

#if !defined(DF_DEPRECATED)
#define DF_DEPRECATED __attribute__((deprecated))
#endif

namespace df {

/// The file that GM.startUp() reads.
const std::string CONFIG_FILENAME = "df-config.txt";

class Config {
 public:
  /// The current world's.
  static Config& getInstance();

  std::string getConfig() const;
  int getWindowHorizontalPixels() const;
  int getWindowVerticalPixels() const;
  int getWindowHorizontalChars() const;
  int getWindowVerticalChars() const;
  Color getWindowBackgroundColor() const;
  int getWindowStyle() const;
  int getFrameTime() const;
  float getFontScale() const;
  std::string getWindowTitle() const;
  bool getShowMouse() const;
  bool getHeadless() const;
  std::string getFontFile() const;
  std::string getLogFile() const;
  int getRandomSeed() const;
  bool getNetworking() const;
  int getQuadtreeDepth() const;
  int getQuadtreeThreshold() const;
  int getGridWidth() const;
  int getGridHeight() const;

  /// The value of a key in what was read; empty if there is none.
  std::string match(const std::string& find) const;

  // They have effect if called before GM.startUp() opens the window; that of the size and the background
  // always (DM.setSize).

  void setConfig(const std::string& config);
  void setWindowHorizontalPixels(int window_horizontal_pixels);
  void setWindowVerticalPixels(int window_vertical_pixels);
  void setWindowHorizontalChars(int window_horizontal_chars);
  void setWindowVerticalChars(int window_vertical_chars);
  void setWindowBackgroundColor(Color window_background_color);
  void setWindowStyle(int window_style);
  void setFrameTime(int frame_time);
  void setFontScale(float font_scale);
  void setWindowTitle(const std::string& window_title);
  void setHeadless(bool headless = true);
  void setShowMouse(bool show_mouse = true);
  void setFontFile(const std::string& font_file);
  void setLogFile(const std::string& logfile);
  void setRandomSeed(int random_seed);
  void setNetworking(bool networking);
  void setQuadtreeDepth(int quadtree_depth);
  void setQuadtreeThreshold(int quadtree_threshold);
  void setGridWidth(int grid_width);
  void setGridHeight(int grid_height);

  /// Write all of it to the log.
  void writeToLog() const;
  /// What the file says, without comments; empty if there is none.
  std::string readConfig();
  /// Take on what `str` says, or the file, if it is empty. What a line says wrongly is logged and left out.
  void loadConfig(const std::string& str = "");

 private:
  Config() = default;
};

}  // namespace df
