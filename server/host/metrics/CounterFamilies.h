// Which metric each counter of the host is: one table for each struct of counters.
//
// A counter that no table has does not compile (CounterFamilies.cpp), so that none is forgotten.
#pragma once

#include "host/auth/PasswordCheck.h"
#include "host/net/NetworkThread.h"
#include "host/session/Counters.h"

namespace naiad {

class Exposition;

/// Write all counters of the struct as families of metrics.
void writeCounters(Exposition& out, const Counters& counters);
void writeCounters(Exposition& out, const PasswordCheck::Counters& counters);
void writeCounters(Exposition& out, const NetworkCounters& counters);

}  // namespace naiad
