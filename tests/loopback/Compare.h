// Compares a client's pictures with the server's.
#pragma once

#include <string>

#include "TestClient.h"
#include "TestServer.h"

namespace naiad::test {

struct Comparison {
  int ticks = 0;  ///< number of compared ticks
  int cells = 0;
  int wrong = 0;
  std::uint64_t wrong_ticks = 0;  ///< ticks with a wrong cell
  std::string first_difference;   ///< text with the tick, its wrong cells and both pictures
};

/// Compares every picture that `client` kept with the server's truth for its player.
Comparison compare(TestClient& client, const TestServer& server);

/// True if the newest picture that `client` kept equals the server's.
bool showsTheTruth(TestClient& client, const TestServer& server);
/// Expects at least `least_ticks` pictures and no wrong cell. Ticks that the server skipped for this client
/// on purpose count as pictures (none, unless the machine stalls for 0.2 s). Prints the result.
void expectSame(TestClient& client, TestServer& server, int least_ticks);

}  // namespace naiad::test
