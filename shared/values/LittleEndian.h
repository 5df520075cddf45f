// Stores and loads numbers in wire order: lowest byte first.
#pragma once

#include <concepts>
#include <cstddef>

namespace naiad {

template <std::unsigned_integral Number>
void storeLittleEndian(Number number, char* out) {
  for (std::size_t i = 0; i < sizeof(Number); ++i) out[i] = static_cast<char>((number >> (8 * i)) & 0xff);
}

template <std::unsigned_integral Number>
Number loadLittleEndian(const char* in) {
  Number number = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    number = static_cast<Number>(number | Number{static_cast<unsigned char>(in[i])} << (8 * i));
  }
  return number;
}

}  // namespace naiad
