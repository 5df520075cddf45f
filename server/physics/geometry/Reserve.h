// Memory for what is about to be added, taken once: growing by doubling writes to twice as many new pages,
// and a page that is written to for the first time costs as much as solving for a contact.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace naiad::physics {

/// Room for `size` elements. It never grows by less than doubling, so that calls that ask for a little more
/// each time stay cheap.
template <class Element>
void reserveFor(std::vector<Element>& elements, std::size_t size) {
  if (elements.capacity() < size) elements.reserve(std::max(size, 2 * elements.capacity()));
}

}  // namespace naiad::physics
