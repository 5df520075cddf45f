// Allowances for tests in sanitizer builds.
#pragma once

namespace naiad::test {

/// True with a sanitizer that tracks memory: heap and time then differ from the product's.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// True with the sanitizer that tracks threads.
#if defined(__SANITIZE_THREAD__)
inline constexpr bool kThreadSanitized = true;
#else
inline constexpr bool kThreadSanitized = false;
#endif

/// Factor for time limits of tests, 1 in the release build. The protocol's own timeouts are equal in all
/// builds.
inline constexpr int kSlowness = kSanitized ? 10 : 1;

/// Divisor for the number of random cases; under a sanitizer fewer are enough.
inline constexpr int kShare = kSanitized ? 4 : 1;

}  // namespace naiad::test
