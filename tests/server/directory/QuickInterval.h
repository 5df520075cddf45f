// --bus-interval of the servers and directories of tests.
#pragma once

namespace naiad::test {

/// Milliseconds: servers come and go within some tenths of a second.
inline constexpr const char* kQuickInterval = "100";

}  // namespace naiad::test
