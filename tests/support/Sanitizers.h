// What a test must know of the build that it is part of.
#pragma once

namespace naiad::test {

/// Built with a sanitizer that keeps books on memory: heap and time are not those of the product.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// How many times as long something may take as in the release build, where time is what is tested. The
/// protocol's own deadlines are the same in all builds.
inline constexpr int kSlowness = kSanitized ? 10 : 1;

/// Of many random cases a sanitizer sees this part: each of them touches the same memory in the same ways.
inline constexpr int kShare = kSanitized ? 4 : 1;

}  // namespace naiad::test
