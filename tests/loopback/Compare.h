// Compares a client's pictures with the server's.
#pragma once

#include "TestClient.h"
#include "TestServer.h"

namespace naiad::test {

/// True if the newest picture that `client` kept equals the server's.
bool showsTheTruth(TestClient& client, const TestServer& server);
/// Expects at least `least_ticks` pictures and no wrong cell. Ticks that the server skipped for this client
/// on purpose count as pictures (none, unless the machine stalls for 0.2 s). Prints the result.
void expectSame(TestClient& client, TestServer& server, int least_ticks);

}  // namespace naiad::test
