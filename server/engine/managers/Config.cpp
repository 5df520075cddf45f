#include "engine/managers/Config.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "engine/sprites/SpriteFile.h"
#include "engine/world/ConfigText.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"

namespace df {

namespace {

// Reads settings from a text "key:value,…", one key with each call.
class Reader {
 public:
  Reader(const std::string& text, World& world) : m_text(text), m_world(world) {}

  void operator()(const char* key, int& out, int least = INT_MIN) {
    const std::string value = valueOf(m_text, key);
    if (value.empty()) return;
    char* p_end = nullptr;
    const long number = std::strtol(value.c_str(), &p_end, 10);
    if (*p_end != '\0' || number < least || number > INT_MAX) return refuse(key, value);
    out = static_cast<int>(number);
  }
  void operator()(const char* key, float& out) {
    const std::string value = valueOf(m_text, key);
    if (value.empty()) return;
    char* p_end = nullptr;
    const float number = std::strtof(value.c_str(), &p_end);
    if (*p_end != '\0' || !(number > 0)) return refuse(key, value);
    out = number;
  }
  void operator()(const char* key, bool& out) {
    const std::string value = valueOf(m_text, key);
    if (value.empty()) return;
    if (value != "true" && value != "false" && value != "1" && value != "0") return refuse(key, value);
    out = value == "true" || value == "1";
  }
  void operator()(const char* key, Color& out) {
    const std::string value = valueOf(m_text, key);
    if (value.empty()) return;
    const Color color = colorOfName(value);
    if (color == UNDEFINED_COLOR) return refuse(key, value);
    out = color;
  }
  void operator()(const char* key, std::string& out) {
    const std::string value = valueOf(m_text, key);
    if (!value.empty()) out = value;
  }

 private:
  void refuse(const char* key, const std::string& value) {
    m_world.log().write("Configuration: " + std::string(key) + ":" + value + " is invalid and ignored");
  }

  const std::string& m_text;
  World& m_world;
};

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
  Reader read(text, world);
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
  return valueOf(settings().text, find);
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
