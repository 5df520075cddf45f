// Finds names that differ in bytes but look the same: Cyrillic "Аnn" and Latin "Ann", "Ilse" and "llse".
#pragma once

#include <string>
#include <vector>

namespace naiad {

/// What `name` (UTF-8) looks like, whatever script and case it is written in: two names that have one of
/// their shapes in common are alike. By the skeletons of Unicode's confusable characters (UTS #39, section
/// 4), of the name with and without its upper case: "I" looks like "l" only while it is upper case. Some
/// microseconds; the first call loads ICU's tables (a few milliseconds), so a server makes one at its start.
/// Any thread.
std::vector<std::string> shapesOf(const std::string& name);

}  // namespace naiad
