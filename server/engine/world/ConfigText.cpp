#include "engine/world/ConfigText.h"

#include <algorithm>

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

}  // namespace df
