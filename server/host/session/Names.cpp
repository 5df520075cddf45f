#include "host/session/Names.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "host/session/LookAlikes.h"
#include "shared/net/base/Limits.h"
#include "shared/values/Canvas.h"

namespace naiad {

namespace {

std::string clean(const std::string& text, std::size_t longest) {
  std::u32string kept;
  for (const char32_t ch : df::decodeUtf8(text)) {
    if (ch == U' ' || ch == U'\t' || ch == 0xA0) {
      if (!kept.empty() && kept.back() != U' ') kept.push_back(U' ');
    } else if (df::isDrawable(ch)) {
      kept.push_back(ch);
    }
  }
  kept.resize(std::min(kept.size(), longest));
  while (!kept.empty() && kept.back() == U' ') kept.pop_back();
  std::string out;
  for (const char32_t ch : kept) df::appendUtf8(out, ch);
  return out;
}

}  // namespace

std::string cleanName(const std::string& wanted) {
  return clean(wanted, kMaxNameLength);
}

std::string uniqueName(const std::string& name, const std::vector<std::string>& taken) {
  std::unordered_set<std::string> shapes;
  for (const std::string& other : taken) {
    for (std::string& shape : shapesOf(other)) shapes.insert(std::move(shape));
  }
  const auto isTaken = [&shapes](const std::string& candidate) {
    const std::vector<std::string> own = shapesOf(candidate);
    return std::any_of(own.begin(), own.end(),
                       [&shapes](const std::string& shape) { return shapes.contains(shape); });
  };
  std::string candidate = name;
  for (int number = 2; isTaken(candidate); ++number) {
    const std::string suffix = std::to_string(number);
    candidate = clean(name, kMaxNameLength - suffix.size()) + suffix;
  }
  return candidate;
}

std::string cleanChat(const std::string& text) {
  return clean(text, kMaxChatLength);
}

}  // namespace naiad
