#include "Names.h"

#include <algorithm>

#include "Canvas.h"
#include "Limits.h"

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

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

}  // namespace

std::string cleanName(const std::string& wanted) {
  return clean(wanted, kMaxNameLength);
}

std::string uniqueName(const std::string& name, const std::vector<std::string>& taken) {
  const auto isTaken = [&taken](const std::string& candidate) {
    return std::any_of(taken.begin(), taken.end(),
                       [&](const std::string& other) { return lower(other) == lower(candidate); });
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
