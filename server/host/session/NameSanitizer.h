// Cleans player names and chat lines, which come from strangers and appear in other players' terminals.
#pragma once

#include <string>
#include <vector>

namespace naiad {

// Some names differ in bytes but look alike: Cyrillic "Аnn" and Latin "Ann", "Ilse" and "llse".

/// Returns the skeletons of `name` (UTF-8): two names look alike if they share one. Skeletons replace
/// Unicode's confusable characters (UTS #39, section 4). They are made of the name with and without its upper
/// case, because "I" looks like "l" only in upper case. Takes some microseconds. The first call loads ICU's
/// tables (a few milliseconds), so a server calls it once at its start. Callable on any thread.
std::vector<std::string> nameSkeletons(const std::string& name);

/// Returns `wanted` with blanks trimmed and collapsed, with only the characters that terminals draw in one
/// cell (df::isDrawable()), truncated to kMaxNameLength characters. Empty if nothing is left.
std::string cleanName(const std::string& wanted);

/// Returns `name` if no name in `taken` equals it or looks like it (nameSkeletons()). Otherwise appends the
/// lowest free number from 2 on, and shortens the name if needed.
std::string uniqueName(const std::string& name, const std::vector<std::string>& taken);

/// Returns a chat line, cleaned like a name and truncated to kMaxChatLength characters.
std::string cleanChat(const std::string& text);

}  // namespace naiad
