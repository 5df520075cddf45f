// Counters of the network and of passwords in a host's log.
#pragma once

#include "host/auth/PasswordCheck.h"
#include "host/net/NetworkThread.h"
#include "shared/program/LineLog.h"

namespace naiad {

/// Log what became of passwords, in one line or none.
void logPasswords(const PasswordCheck::Counters& passwords, const LogLine& log);
/// Log what was refused or dropped before it reached a session, in up to three lines. After the network's
/// stop().
void logRefusals(const NetworkThread& network, const LogLine& log);

}  // namespace naiad
