// Wire messages in the codec without protobuf: for all bytes, it accepts what protobuf accepts and finds
// equal fields.
//
//   input   which message (1) | its bytes
#include <tuple>

#include "Target.h"
#include "naiad.twins.h"
#include "proto/ParseErrors.h"

namespace naiad::fuzz {
namespace {

template <class Twins>
void compare(std::string_view bytes) {
  const Exactly exactly(bytes);
  typename Twins::Real real, known;
  typename Twins::Small small, again;
  const int size = static_cast<int>(bytes.size());
  const bool good = real.ParseFromArray(exactly.view().data(), size);
  REQUIRE(small.ParseFromArray(exactly.view().data(), size) == good);
  if (!good) return;
  Twins::copy(real, known);  // `known`: a copy of `real` without unknown fields
  const std::string written = small.SerializeAsString();
  REQUIRE(written == known.SerializeAsString());
  REQUIRE(again.ParseFromString(written) && again.SerializeAsString() == written);
  again = small;
  REQUIRE(again.SerializeAsString() == written);
}

template <class... Twins>
void compareOne(std::size_t which, std::string_view bytes, const std::tuple<Twins...>*) {
  constexpr void (*kCompare[])(std::string_view) = {&compare<Twins>...};
  kCompare[which % sizeof...(Twins)](bytes);
}

}  // namespace

void tryInput(Script script) {
  silenceParseErrors();
  const std::size_t which = script.byte();
  const std::string bytes = script.rest();
  const test::naiad_twins::In<std::tuple>* all = nullptr;
  compareOne(which, bytes, all);
}

}  // namespace naiad::fuzz
