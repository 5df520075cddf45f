// Holding a client's pictures against what the server drew.
#pragma once

#include <string>

#include "TestClient.h"
#include "TestServer.h"

namespace naiad::test {

struct Comparison {
  int ticks = 0;  ///< compared
  int cells = 0;
  int wrong = 0;
  std::uint64_t wrong_ticks = 0;  ///< with at least one wrong cell
  std::string first_difference;   ///< for people: the tick, its wrong cells, both pictures
};

/// Compare every picture that `client` kept with the server's truth for its player.
Comparison compare(TestClient& client, const TestServer& server);

/// Is the newest picture that `client` kept the server's?
bool showsTheTruth(TestClient& client, const TestServer& server);
/// Expect `least_ticks` pictures and no wrong cell, but for ticks that the server skipped for this client on
/// purpose (none, unless the machine stands still for a fifth of a second). Print what was compared.
void expectSame(TestClient& client, TestServer& server, int least_ticks);

}  // namespace naiad::test
