#include "client/terminal/AsciiFallback.h"

#include <string_view>

namespace naiad {

char asciiFor(char32_t ch) {
  if (ch >= 0x20 && ch < 0x7F) return static_cast<char>(ch);
  struct Likeness {
    std::u32string_view glyphs;
    char ascii;
  };
  static constexpr Likeness kAlike[] = {
      {U"─━┄┅┈┉╌╍═‐‑‒–—―−", '-'},
      {U"│┃┆┇┊┋╎╏║", '|'},
      {U"←⇐◀◁◂◃◄◅‹«", '<'},
      {U"→⇒▶▷▸▹►▻›»", '>'},
      {U"↑⇑▲△▴▵", '^'},
      {U"↓⇓▼▽▾▿", 'v'},
      {U"•●∙◆◇◈◉◎★☆✶⋆∗×", '*'},
      {U"○◌◦°¤◯", 'o'},
      {U"·‥…‧", '.'},
      {U"‘’‚‛´", '\''},
      {U"“”„‟¨", '"'},
      {U"╱", '/'},
      {U"╲", '\\'},
      {U"╳", 'X'},
      {U"±", '+'},
      {U"≈∼", '~'},
      {U"≠≡", '='},
      {U"¡", '!'},
      {U"¦", '|'},
      {U"àáâãäåāăą", 'a'},
      {U"ÀÁÂÃÄÅĀĂĄ", 'A'},
      {U"çćĉċč", 'c'},
      {U"ÇĆĈĊČ", 'C'},
      {U"èéêëēĕėęě", 'e'},
      {U"ÈÉÊËĒĔĖĘĚ", 'E'},
      {U"ìíîïĩīĭį", 'i'},
      {U"ÌÍÎÏĨĪĬĮ", 'I'},
      {U"ñńņň", 'n'},
      {U"ÑŃŅŇ", 'N'},
      {U"òóôõöøōŏő", 'o'},
      {U"ÒÓÔÕÖØŌŎŐ", 'O'},
      {U"ùúûüũūŭůűų", 'u'},
      {U"ÙÚÛÜŨŪŬŮŰŲ", 'U'},
      {U"ß", 's'},
  };
  for (const Likeness& likeness : kAlike) {
    if (likeness.glyphs.find(ch) != std::u32string_view::npos) return likeness.ascii;
  }
  if (ch == 0xA0) return ' ';
  if (ch >= 0x2500 && ch <= 0x257F) return '+';  // other box-drawing characters: corners and crossings
  if (ch >= 0x2580 && ch <= 0x25A9) return '#';  // blocks, shades, squares
  if (ch >= 0x2800 && ch <= 0x28FF) return ch == 0x2800 ? ' ' : ':';
  return '?';
}

}  // namespace naiad
