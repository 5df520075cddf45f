#include "host/session/LookAlikes.h"

#include <unicode/unistr.h>
#include <unicode/uspoof.h>

namespace naiad {

namespace {

using icu::UnicodeString;

/// Characters replaced by those they look like. The text itself if ICU has no tables.
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

}  // namespace

// The inner skeleton comes before folding, since a capital of another script looks like a Latin one and its
// small letter often does not; the outer one, since that small letter has a skeleton, too ("m" is "rn").
std::vector<std::string> shapesOf(const std::string& name) {
  const UnicodeString text = UnicodeString::fromUTF8(name);
  return {utf8(skeleton(folded(skeleton(text)))), utf8(skeleton(folded(text)))};
}

}  // namespace naiad
