// How servers of a fleet are called on the bus.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace naiad {

inline constexpr std::size_t kMaxServerId = 48;

/// 1 to kMaxServerId of a-z, 0-9 and '-', beginning with a letter or digit: one word of a subject, whose
/// parts are separated by dots.
bool isServerId(std::string_view text);
/// The same made of any text: others become '-'. "server" if nothing is left.
std::string serverIdOf(std::string_view text);

/// "naiad.presence.ID", "naiad.results.ID", "naiad.sendon.ID".
std::string presenceSubject(std::string_view id);
std::string resultSubject(std::string_view id);
std::string sendOnSubject(std::string_view id);

}  // namespace naiad
