#include "host/session/NameSanitizer.h"

#include <unicode/unistr.h>
#include <unicode/uspoof.h>

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "shared/net/base/Limits.h"
#include "shared/values/Canvas.h"

namespace naiad {

namespace {

using icu::UnicodeString;

/// Replaces each character by the one it looks like. Returns the text itself if ICU has no tables.
UnicodeString skeleton(const UnicodeString& text) {
  static const icu::LocalUSpoofCheckerPointer checker = [] {
    UErrorCode error = U_ZERO_ERROR;
    return icu::LocalUSpoofCheckerPointer(uspoof_open(&error));
  }();
  UErrorCode error = U_ZERO_ERROR;
  UnicodeString result;
  if (checker.isValid()) uspoof_getSkeletonUnicodeString(checker.getAlias(), 0, text, result, &error);
  return checker.isValid() && U_SUCCESS(error) ? result : text;
}

UnicodeString folded(UnicodeString text) {
  return text.foldCase();
}

std::string utf8(const UnicodeString& text) {
  std::string out;
  return text.toUTF8String(out);
}

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

// The inner skeleton is made before folding, because a foreign capital can look Latin while its small letter
// does not. The outer one is made after folding, because small letters have skeletons, too ("m" is "rn").
std::vector<std::string> nameSkeletons(const std::string& name) {
  const UnicodeString text = UnicodeString::fromUTF8(name);
  return {utf8(skeleton(folded(skeleton(text)))), utf8(skeleton(folded(text)))};
}

std::string cleanName(const std::string& wanted) {
  return clean(wanted, kMaxNameLength);
}

std::string uniqueName(const std::string& name, const std::vector<std::string>& taken) {
  std::unordered_set<std::string> skeletons;
  for (const std::string& other : taken) {
    for (std::string& shape : nameSkeletons(other)) skeletons.insert(std::move(shape));
  }
  const auto isTaken = [&skeletons](const std::string& candidate) {
    const std::vector<std::string> own = nameSkeletons(candidate);
    return std::any_of(own.begin(), own.end(),
                       [&skeletons](const std::string& shape) { return skeletons.contains(shape); });
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
