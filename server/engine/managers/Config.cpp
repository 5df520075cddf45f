#include "engine/managers/Config.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

#include "engine/sprites/SpriteFile.h"
#include "engine/world/ConfigText.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"
#include "shared/options/Options.h"

namespace df {

namespace {

/// Keys that loadConfig() does not look up.
constexpr const char* kOtherKeys[] = {"window_style", "window_state",       "signals",
                                      "grid_width",   "grid_height",        "quadtree_depth",
                                      "server_plays", "quadtree_threshold", "fullscreen"};

bool parse(const std::string& value, int& out, int least) {
  char* p_end = nullptr;
  const long number = std::strtol(value.c_str(), &p_end, 10);
  if (*p_end != '\0' || number < least || number > INT_MAX) return false;
  out = static_cast<int>(number);
  return true;
}

bool parse(const std::string& value, float& out, int /*least*/) {
  char* p_end = nullptr;
  const float number = std::strtof(value.c_str(), &p_end);
  if (*p_end != '\0' || !(number > 0)) return false;
  out = number;
  return true;
}

bool parse(const std::string& value, bool& out, int /*least*/) {
  out = value == "true" || value == "1";
  return out || value == "false" || value == "0";
}

bool parse(const std::string& value, Color& out, int /*least*/) {
  const Color color = colorOfName(value);
  if (color != UNDEFINED_COLOR) out = color;
  return color != UNDEFINED_COLOR;
}

bool parse(const std::string& value, std::string& out, int /*least*/) {
  out = value;
  return true;
}

/// Reads one setting from the configuration. Logs and ignores an invalid value.
template <class Value>
void read(const char* key, Value& out, int least = INT_MIN) {
  const std::string value = Config::getInstance().match(key);
  Value parsed = out;
  if (value.empty() || parse(value, parsed, least)) {
    out = parsed;
  } else {
    World::current().log().write("Configuration: " + std::string(key) + ":" + value +
                                 " is invalid and ignored");
  }
}

}  // namespace

ConfigSettings& Config::settings() {
  return World::current().extras().settings;
}

void Config::applyWindow() {
  World& world = World::current();
  const ConfigSettings& s = settings();
  const bool chars =
      s.window_horizontal_chars != world.views().width() || s.window_vertical_chars != world.views().height();
  if (chars && world.views().setWindow(s.window_horizontal_chars, s.window_vertical_chars) != 0) {
    world.log().write("Configuration: invalid window of " + std::to_string(s.window_horizontal_chars) +
                      " by " + std::to_string(s.window_vertical_chars) + " characters");
  }
  world.extras().background = s.window_background_color;
}

Config& Config::getInstance() {
  static Config* p_instance = new Config;
  return *p_instance;
}

std::string Config::readConfig() {
  const char* p_named = std::getenv("DRAGONFLY_CONFIG");
  const std::string name = p_named != nullptr ? p_named : CONFIG_FILENAME;
  std::error_code error;
  if (!std::filesystem::is_regular_file(name, error)) {  // opening a pipe would wait for its writer
    if (std::filesystem::is_fifo(name, error))
      World::current().log().write("Configuration: " + name + " is a pipe and is not read");
    return {};
  }
  std::ifstream file(name);
  std::string text;
  for (std::string line; std::getline(file, line);) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first != std::string::npos && line[first] != '#') text += line + "\n";
  }
  return text;
}

void Config::loadConfig(const std::string& str) {
  const std::string text = str.empty() ? readConfig() : str;
  if (text.empty()) return;
  World& world = World::current();
  ConfigSettings& s = settings();
  s.text = text;
  s.known_keys.assign(std::begin(kOtherKeys), std::end(kOtherKeys));
  read("window_horizontal_pixels", s.window_horizontal_pixels, 1);
  read("window_vertical_pixels", s.window_vertical_pixels, 1);
  read("window_horizontal_chars", s.window_horizontal_chars, 1);
  read("window_vertical_chars", s.window_vertical_chars, 1);
  read("window_background_color", s.window_background_color);
  read("window_title", s.window_title);
  read("frame_time", s.frame_time, 1);
  read("font_scale", s.font_scale);
  read("font_file", s.font_file);
  read("mouse_cursor", s.show_mouse);
  read("headless", s.headless);
  read("logfile", s.logfile);
  read("random_seed", s.random_seed, -1);
  read("networking", s.networking);
  bool compat = world.compat();
  read("compat", compat);
  world.setCompat(compat);
  if (s.random_seed > 0) world.setSeed(static_cast<std::uint64_t>(s.random_seed));
  applyWindow();
}

std::string Config::match(const std::string& find) const {
  std::vector<std::string>& known = settings().known_keys;
  if (std::find(known.begin(), known.end(), find) == known.end()) known.push_back(find);
  return valueOf(settings().text, find);
}

// A game that is not a program itself does not read the keys of the host's options, which its file may have.
void Config::reportUnknownKeys() {
  const World& world = World::current();
  if (world.findExtras() == nullptr) return;
  std::istringstream pairs(settings().text);
  for (std::string pair; std::getline(pairs, pair, ',');) {
    std::istringstream lines(pair);
    for (std::string line, before; std::getline(lines, line); before += line) {
      std::erase_if(line, [](char c) { return c == ' ' || c == '\t' || c == '\r'; });
      const std::string key = line.substr(0, line.find(':'));
      if (key.empty()) continue;
      if (!before.empty()) world.log().writeOnce("Configuration: a comma is missing before " + key);
      const std::vector<std::string>& known = settings().known_keys;
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      const std::string near = naiad::suggestion(key, known);
      if (near.empty() && world.program() == nullptr) continue;
      std::string problem = "Configuration: there is no key \"" + key + '"';
      world.log().writeOnce(problem += near);
    }
  }
}

void Config::writeToLog() const {
  const ConfigSettings& s = settings();
  std::ostringstream out;
  out << "Configuration: window " << s.window_horizontal_chars << " by " << s.window_vertical_chars
      << " characters, frame_time " << s.frame_time << ", random_seed " << s.random_seed << ", headless "
      << s.headless << ", logfile " << s.logfile;
  World::current().log().write(out.str());
}

}  // namespace df
