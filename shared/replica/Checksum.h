// The checksum that server and client compare to find out whether their worlds are equal.
//
// Every group of attributes of every object that a client has contributes 64 bits. Their sum modulo 2^64 does
// not depend on the order, and each side updates it group by group. It detects mistakes, not attacks.
#pragma once

#include <cstdint>

#include "shared/replica/Records.h"

namespace naiad {

std::uint64_t lifeSum(std::uint32_t id, std::uint8_t generation, std::uint64_t order);
/// Returns a sum that does not depend on the base tick: motions with equal paths have equal sums.
std::uint64_t motionSum(std::uint32_t id, const Motion& motion);
/// If the look's clock loops, all starts that show equal frames give one sum. If the clock stops, only equal
/// starts do. See rebase().
std::uint64_t lookSum(std::uint32_t id, const Look& look);
std::uint64_t bodySum(std::uint32_t id, const Body& body);

}  // namespace naiad
