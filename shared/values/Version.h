// The version of engine, server and client.
#pragma once

namespace naiad {

/// The version of the programs and the library.
inline constexpr const char* kVersion = "0.2.0";

}  // namespace naiad
