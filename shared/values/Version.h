// The version of engine, server and client.
#pragma once

namespace naiad {

/// Of programs and library.
inline constexpr const char* kVersion = "0.2.0";

}  // namespace naiad
