// Players in a process of their own: one thread cannot serve a thousand of them as a player's own machine
// would.
//
// It reads commands, a line each, and answers each with a line of numbers:
//
//   join AT_ONCE   they come, so many at a time         0
//   state                                               PLAYING LOSSES; "problem SENTENCE": one cannot join
//   kill PORT      that server is about to be killed    players who are there
//   waiting                                             of them, those who are not back yet
//   result                                              RETURNED DISTURBED MS... of those who are back
//   redirects                                           MS... of those who were sent on
//   leave          and it ends                          0
#pragma once

#include <filesystem>
#include <string>

namespace bench {

/// Until "leave", or its input ends. Throws std::runtime_error for a link that is none.
void serveCrowd(const std::string& link, const std::filesystem::path& known_servers, int first, int count);

}  // namespace bench
