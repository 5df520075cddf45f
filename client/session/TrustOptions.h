// The options that dfclient and dfbot share: the server, which key it must have, and the password.
#pragma once

#include <string>
#include <vector>

#include "client/session/Connection.h"
#include "shared/options/Options.h"

namespace naiad {

Option serverOption(std::string& server);
std::vector<Option> trustOptions(ServerTrust& trust, SessionOptions& session);

}  // namespace naiad
