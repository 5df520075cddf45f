// The --bus-interval of servers and directories in tests.
#pragma once

namespace naiad::test {

/// Milliseconds; short, so that changes of servers are noticed within some tenths of a second.
inline constexpr const char* kQuickInterval = "100";

}  // namespace naiad::test
