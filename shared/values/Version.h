// The version of engine, server and client.
#pragma once

namespace naiad {

inline constexpr const char* kVersion = "0.1.0";

}  // namespace naiad
