// The functions of utility.h that are about text.

#include <array>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <sstream>

#include "engine/managers/GameManager.h"
#include "engine/managers/LogManager.h"
#include "engine/published/NetworkNode.h"
#include "engine/published/utility.h"
#include "engine/world/ConfigText.h"
#include "engine/world/World.h"

namespace df {

namespace {

template <std::size_t N>
std::string nameAt(const std::array<const char*, N>& names, int index) {
  return index >= 0 && index < static_cast<int>(N) ? names[static_cast<std::size_t>(index)] : "undefined";
}

}  // namespace

std::string toString(int i) {
  return std::to_string(i);
}

std::string toString(float f) {
  std::ostringstream out;
  out << f;
  return out.str();
}

std::string toString(char c) {
  return std::string(1, c);
}

std::string toString(bool b) {
  return b ? "true" : "false";
}

std::string toString(Color color) {
  return nameAt(std::array{"black", "red", "green", "yellow", "blue", "magenta", "cyan", "white", "custom"},
                color);
}

std::string toString(const Shape& shape) {
  return shape.toString();
}

std::string toString(const Path& path) {
  return path.toString();
}

std::string toString(Keyboard::Key key_val) {
  return nameOfKey(key_val);
}

std::string toString(Solidness solid) {
  return nameAt(std::array{"hard", "soft", "spectral"}, solid);
}

std::string toString(ViewObjectLocation location) {
  return nameAt(std::array{"top-left", "top-center", "top-right", "center-left", "center-center",
                           "center-right", "bottom-left", "bottom-center", "bottom-right"},
                location);
}

std::string toString(MessageType message) {
  return nameAt(std::array{"sync-object", "delete-object", "game-over", "keyboard-input", "mouse-input",
                           "custom-message"},
                static_cast<int>(message));
}

std::string maskToString(unsigned int mask) {
  std::string text;
  for (unsigned bit = 1u << 31; bit != 0; bit >>= 1) text += (mask & bit) != 0 ? '1' : '0';
  return text;
}

std::string match(const std::string& str, const std::string& find) {
  thread_local std::string last;
  if (!str.empty()) last = str;
  return valueOf(last, find);
}

char* getTimeString() {
  thread_local std::array<char, 32> text;
  const std::int64_t steps = GM.getStepCount();
  const int frame = GM.getFrameTime();  // the default of 33 ms means exactly 1/30 s
  const auto seconds = static_cast<int>(frame == FRAME_TIME_DEFAULT ? steps / 30 : steps * frame / 1000);
  std::snprintf(text.data(), text.size(), "%02d:%02d:%02d", seconds / 3600, seconds / 60 % 60, seconds % 60);
  return text.data();
}

int stringStreamCheck(const char* prefix, std::stringstream* p_ss) {
  if (p_ss != nullptr && !p_ss->fail()) return 0;
  LM.writeLog("%s: the stream has failed", prefix != nullptr ? prefix : "");
  return -1;
}

}  // namespace df
