#include "engine/world/ConfigText.h"

#include <algorithm>
#include <charconv>

namespace df {

std::string valueOf(const std::string& text, const std::string& key) {
  const auto isBlank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    std::string pair = text.substr(begin, end - begin);
    begin = end + 1;
    std::erase_if(pair, isBlank);
    if (pair.size() > key.size() && pair[key.size()] == ':' && pair.compare(0, key.size(), key) == 0) {
      return pair.substr(key.size() + 1);
    }
  }
  return {};
}

std::optional<double> numberOf(const std::string& text, const std::string& key) {
  const std::string value = valueOf(text, key);
  double result = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), result);
  if (value.empty() || error != std::errc() || end != value.data() + value.size()) return std::nullopt;
  return result;
}

std::optional<Vector> vectorOf(const std::string& text, const std::string& key) {
  const auto x = numberOf(text, key + "-x");
  const auto y = numberOf(text, key + "-y");
  if (!x || !y) return std::nullopt;
  return Vector(*x, *y);
}

std::string keyValue(const std::string& key, const std::string& value) {
  return key + ":" + value + ",";
}

std::string keyValue(const std::string& key, double value) {
  char buffer[64];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return keyValue(key, error == std::errc() ? std::string(buffer, end) : "0");
}

std::string keyValue(const std::string& key, Vector v) {
  return keyValue(key + "-x", v.x()) + keyValue(key + "-y", v.y());
}

}  // namespace df
