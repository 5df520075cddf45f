// Reserves memory once for elements that are about to be added. A vector that grows by doubling writes to
// twice as many new pages, and the first write to a page costs as much as the solution of a contact.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace naiad::physics {

/// Makes room for `size` elements. At least doubles the capacity if it grows, so that repeated calls with
/// slightly larger sizes stay cheap.
template <class Element>
void reserveFor(std::vector<Element>& elements, std::size_t size) {
  if (elements.capacity() < size) elements.reserve(std::max(size, 2 * elements.capacity()));
}

}  // namespace naiad::physics
