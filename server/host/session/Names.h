// Cleans player names and chat: strangers send them, and other players' terminals show them.
#pragma once

#include <string>
#include <vector>

namespace naiad {

// Finds names that differ in bytes but look the same: Cyrillic "Аnn" and Latin "Ann", "Ilse" and "llse".

/// What `name` (UTF-8) looks like, whatever script and case it is written in: two names that have one of
/// their shapes in common are alike. By the skeletons of Unicode's confusable characters (UTS #39, section
/// 4), of the name with and without its upper case: "I" looks like "l" only while it is upper case. Some
/// microseconds; the first call loads ICU's tables (a few milliseconds), so a server makes one at its start.
/// Any thread.
std::vector<std::string> shapesOf(const std::string& name);

/// `wanted` with blanks trimmed and collapsed, without characters that no terminal draws in one cell, cut to
/// kMaxNameLength characters. Empty if nothing is left.
std::string cleanName(const std::string& wanted);

/// `name`, or where it is taken (so is one that looks like another: shapesOf()), `name` with the lowest
/// number from 2 on that is free, cut so that it still fits.
std::string uniqueName(const std::string& name, const std::vector<std::string>& taken);

/// A line of chat, cleaned as a name is and cut to kMaxChatLength characters.
std::string cleanChat(const std::string& text);

}  // namespace naiad
