// The sum by which server and client make sure that they mean the same world.
//
// Every group of every object a client holds gives 64 bits; the sum of all of them, modulo 2^64, depends on
// no order, and each side keeps it up to date group by group. It guards against mistakes, not attacks.
#pragma once

#include <cstdint>

#include "shared/replica/Records.h"

namespace naiad {

std::uint64_t lifeSum(std::uint32_t id, std::uint8_t generation, std::uint64_t order);
/// Any base tick of the same path gives the same sum.
std::uint64_t motionSum(std::uint32_t id, const Motion& motion);
/// For a clock that goes round, any start that shows the same gives the same sum; for one that stops, only
/// the start that was sent. See rebase().
std::uint64_t lookSum(std::uint32_t id, const Look& look);
std::uint64_t bodySum(std::uint32_t id, const Body& body);

}  // namespace naiad
