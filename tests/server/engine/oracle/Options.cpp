#include "Options.h"

#include <array>

namespace oracle {

OptionMix OptionMix::random(Rng& rng) {
  OptionMix mix;
  mix.any = rng.chance(50);
  constexpr std::array<int, 4> percents{10, 30, 60, 100};
  const int which = rng.below(8);
  if (!mix.any) return mix;
  // The options of each kind of mix: swept, precise, masked, rest_contacts and may_move_out, as bits.
  constexpr std::array<unsigned, 8> kinds{0b10000, 0, 0b01100, 0b11100, 0b00011, 0, 0b10001, 0b11111};
  unsigned bit = 0b10000;
  for (const auto option : {&OptionMix::swept, &OptionMix::precise, &OptionMix::masked,
                            &OptionMix::rest_contacts, &OptionMix::may_move_out}) {
    if ((kinds[static_cast<std::size_t>(which)] & bit) != 0)
      mix.*option = percents[static_cast<std::size_t>(rng.below(4))];
    bit /= 2;
  }
  if (which == 1) mix.sweep_all = true;
  if (which == 1) mix.scripts_sweep = rng.chance(20);
  if (which == 7) mix.scripts_sweep = rng.chance(50);
  if (which == 5) {  // all options, each rare
    mix.swept = mix.precise = mix.rest_contacts = mix.may_move_out = 5;
    mix.masked = 20;
    mix.scripts_sweep = true;
  }
  return mix;
}

Options OptionMix::randomOptions(Rng& rng) const {
  Options options;
  options.swept = rng.chance(swept);
  options.precise = rng.chance(precise);
  options.rest_contacts = rng.chance(rest_contacts);
  options.may_move_out = rng.chance(may_move_out);
  return options;
}

Mask OptionMix::randomMask(Rng& rng) const {
  Mask mask;
  Rng own(rng.next());
  if (!own.chance(masked)) return mask;
  const int size = own.below(20);
  auto width = static_cast<int>(own.between(1, 6));
  auto height = static_cast<int>(own.between(1, 4));
  if (size >= 17) {  // larger than most boxes
    width = static_cast<int>(own.between(1, 14));
    height = static_cast<int>(own.between(1, 8));
  }
  if (size == 19) width = static_cast<int>(own.between(60, 140));
  constexpr std::array<int, 5> fillings{100, 80, 50, 25, 3};
  const int filling = fillings[static_cast<std::size_t>(own.below(5))];

  for (int y = 0; y < height; ++y) {
    std::string row;
    for (int x = 0; x < width; ++x) row += own.chance(filling) ? '#' : ' ';
    mask.push_back(row);
  }
  // Rows may differ in length, and one may be empty.
  if (height > 1 && own.chance(30)) mask.back().resize(static_cast<std::size_t>(own.below(width)));
  return mask;
}

}  // namespace oracle
