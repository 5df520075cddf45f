// Cleans player names and chat: strangers send them, and other players' terminals show them.
#pragma once

#include <string>
#include <vector>

namespace naiad {

/// `wanted` with blanks trimmed and collapsed, without characters that no terminal draws in one cell, cut to
/// kMaxNameLength characters. Empty if nothing is left.
std::string cleanName(const std::string& wanted);

/// `name`, or where it is taken (so is one that looks like another: LookAlikes.h), `name` with the lowest
/// number from 2 on that is free, cut so that it still fits.
std::string uniqueName(const std::string& name, const std::vector<std::string>& taken);

/// A line of chat, cleaned as a name is and cut to kMaxChatLength characters.
std::string cleanChat(const std::string& text);

}  // namespace naiad
