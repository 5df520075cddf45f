// Draws the client's picture on a canvas. Cells have a size in whole device pixels, so that nothing is blurred.
// Lines, blocks and Braille patterns are drawn as shapes instead of text, so that they meet at the edges of cells.

const colors = ["#4d4d4d", "#ff5555", "#50fa7b", "#f1fa8c", "#7aa2ff", "#ff79c6", "#8be9fd", "#e4e4e4"];
const paper = "#000000";
const backgrounds = [paper, "#7a1414", "#14602a", "#6a6a14", "#1a2f7a", "#6a1a5a", "#14606a", "#b0b0b0"];
const family = '"Naiad Mono"';
/** Metrics of the font: advance and line height relative to its size, baseline relative to the line height. */
const advance = 0.602;
const lineHeight = 1.17;
const baseline = 0.79;
const mostImages = 4000;
const smallest = 11;  // smallest line height, in CSS pixels
const largest = 48;

/** Arms of the characters U+2500 … U+257F: left, up, right, down; 0 none, 1 light, 2 heavy, 3 double. */
const arms = new Map();
for (const [chars, text] of [
  ["─━│┃", "1010 2020 0101 0202"], ["┌┍┎┏", "0011 0021 0012 0022"], ["┐┑┒┓", "1001 2001 1002 2002"],
  ["└┕┖┗", "0110 0120 0210 0220"], ["┘┙┚┛", "1100 2100 1200 2200"], ["├┝┞┟┠┡┢┣", "0111 0121 0211 0112 0212 0221 0122 0222"],
  ["┤┥┦┧┨┩┪┫", "1101 2101 1201 1102 1202 2201 2102 2202"], ["┬┭┮┯┰┱┲┳", "1011 2011 1021 2021 1012 2012 1022 2022"],
  ["┴┵┶┷┸┹┺┻", "1110 2110 1120 2120 1210 2210 1220 2220"], ["┼┽┾┿╀╁╂", "1111 2111 1121 2121 1211 1112 1212"],
  ["╃╄╅╆╇╈╉╊╋", "2211 1221 2112 1122 2221 2122 2212 1222 2222"], ["═║", "3030 0303"], ["╒╓╔╕╖╗", "0031 0013 0033 3001 1003 3003"],
  ["╘╙╚╛╜╝", "0130 0310 0330 3100 1300 3300"], ["╞╟╠╡╢╣", "0131 0313 0333 3101 1303 3303"], ["╤╥╦╧╨╩╪╫╬", "3031 1013 3033 3130 1310 3330 3131 1313 3333"],
  ["╭╮╯╰", "0011 1001 1100 0110"], ["╴╵╶╷╸╹╺╻", "1000 0100 0010 0001 2000 0200 0020 0002"], ["╼╽╾╿", "1020 0102 2010 0201"],
]) {
  const parts = text.split(" ");
  [...chars].forEach((ch, i) => arms.set(ch.codePointAt(0), [...parts[i]].map(Number)));
}

export class Picture {
  constructor(canvas) {
    this.canvas = canvas;
    this.screen = canvas.getContext("2d", {alpha: false});
    this.drawn = new Map();  // images of cells, by the packed cell
    this.shown = new Uint32Array(0);
    this.columns = 0;
    this.rows = 0;
    this.cursor = -1;
  }

  /**
   * Chooses the largest cell size with which `columns` by `rows` cells fit into width by height CSS pixels. Cells stay
   * large enough to be read; if necessary, fewer fit. Returns the number of columns and rows that fit.
   */
  fit(width, height, columns, rows) {
    const scale = window.devicePixelRatio || 1;
    const wide = Math.floor(width * scale);
    const high = Math.floor(height * scale);
    const cell = (line) => Math.max(1, Math.round(line / lineHeight * advance));
    let line = Math.floor(Math.min(largest * scale, high / rows));
    while (line > smallest * scale && cell(line) * columns > wide) --line;
    line = Math.max(line, Math.round(smallest * scale));
    const size = {columns: Math.max(1, Math.min(400, Math.floor(wide / cell(line)))), rows: Math.max(1, Math.min(150, Math.floor(high / line)))};
    if (line !== this.line || scale !== this.scale || size.columns !== this.columns || size.rows !== this.rows) {
      Object.assign(this, {line, scale, cell: cell(line), columns: size.columns, rows: size.rows});
      this.drawn.clear();
      this.canvas.width = this.cell * size.columns;
      this.canvas.height = line * size.rows;
      this.canvas.style.width = `${this.canvas.width / scale}px`;
      this.canvas.style.height = `${this.canvas.height / scale}px`;
      this.redraw();
    }
    return size;
  }

  /** Makes the next show() draw everything. */
  redraw() {
    this.screen.fillStyle = paper;
    this.screen.fillRect(0, 0, this.canvas.width, this.canvas.height);
    this.shown = new Uint32Array(0);
  }

  /** Draws the cells that have changed. The picture may still have the size before the last fit(). */
  show({columns, rows, cells, cursor}) {
    const all = this.shown.length !== cells.length || this.shownColumns !== columns;
    if (all) this.redraw();
    for (let i = 0; i < cells.length; ++i) {
      if (!all && this.shown[i] === cells[i] && i !== this.cursorCell) continue;
      const column = i % columns;
      const row = (i - column) / columns;
      if (column < this.columns && row < this.rows) this.screen.drawImage(this.image(cells[i]), column * this.cell, row * this.line);
    }
    this.cursorCell = cursor < 0 ? -1 : (cursor >> 16) * columns + (cursor & 0xffff);
    if (cursor >= 0) this.drawCursor(cursor & 0xffff, cursor >> 16);
    if (all) this.shown = new Uint32Array(cells);
    else this.shown.set(cells);
    this.shownColumns = columns;
  }

  /** Returns the image of a cell. It clips the character, whose overhang would not be erased with the cell. */
  image(cell) {
    let image = this.drawn.get(cell);
    if (image !== undefined) return image;
    if (this.drawn.size >= mostImages) this.drawn.clear();
    image = new OffscreenCanvas(this.cell, this.line);
    this.drawCell(image.getContext("2d", {alpha: false}), cell);
    this.drawn.set(cell, image);
    return image;
  }

  drawCell(context, cell) {
    const style = cell >>> 24 & 3;
    let ink = colors[cell >>> 21 & 7];
    let ground = backgrounds[cell >>> 26 & 7];
    if (style === 2) [ink, ground] = [paper, ink === colors[7] ? "#c8c8c8" : ink];
    context.fillStyle = ground;
    context.fillRect(0, 0, this.cell, this.line);
    const code = cell & 0x1fffff;
    if (code === 0x20 || code === 0xa0) return;
    context.fillStyle = ink;
    if (code >= 0x2500 && code <= 0x28ff && this.drawShape(context, code)) return;
    context.font = `${style === 1 ? "bold " : ""}${this.line / lineHeight}px ${family}, monospace`;
    context.textBaseline = "alphabetic";
    context.textAlign = "center";
    context.fillText(String.fromCodePoint(code), this.cell / 2, Math.round(this.line * baseline), this.cell);
  }

  drawCursor(column, row) {
    this.screen.fillStyle = "#000000";
    this.screen.fillRect(column * this.cell, row * this.line + this.line - Math.max(2, this.line >> 3), this.cell, Math.max(2, this.line >> 3));
  }

  /** Draws a line, block or Braille character. Returns false for other characters. */
  drawShape(context, code) {
    if (code <= 0x257f) return this.drawLines(context, code);
    if (code <= 0x259f) return this.drawBlock(context, code);
    return code >= 0x2800 && this.drawBraille(context, code);
  }

  drawLines(context, code) {
    const arm = arms.get(code);
    if (arm === undefined) return false;
    const {cell, line} = this;
    const light = Math.max(1, Math.round(cell / 8));
    const gap = light;
    const middleX = cell - light >> 1;
    const middleY = line - light >> 1;
    const [left, up, right, down] = arm;
    // Offset from the middle, and width, of each stroke of an arm.
    const across = (kind) => kind === 0 ? [] : kind === 3 ? [[-gap, light], [gap, light]] : [[-(kind - 1) * (light >> 1), light * kind]];
    const horizontal = (from, to, kind) => {
      for (const [shift, width] of across(kind)) context.fillRect(from, middleY + shift, to - from, width);
    };
    const vertical = (from, to, kind) => {
      for (const [shift, width] of across(kind)) context.fillRect(middleX + shift, from, width, to - from);
    };
    // Arms extend past the middle by the gap of double lines that they meet.
    const reachX = up === 3 || down === 3 ? gap : 0;
    const reachY = left === 3 || right === 3 ? gap : 0;
    horizontal(0, middleX + light + reachX, left);
    horizontal(middleX - reachX, cell, right);
    vertical(0, middleY + light + reachY, up);
    vertical(middleY - reachY, line, down);
    return true;
  }

  drawBlock(context, code) {
    const {cell, line} = this;
    const part = (left, top, right, bottom) => {
      const x0 = Math.round(cell * left / 8), x1 = Math.round(cell * right / 8);
      const y0 = Math.round(line * top / 8), y1 = Math.round(line * bottom / 8);
      context.fillRect(x0, y0, x1 - x0, y1 - y0);
    };
    const n = code - 0x2580;
    if (n === 0) part(0, 0, 8, 4);
    else if (n <= 8) part(0, 8 - n, 8, 8);
    else if (n <= 15) part(0, 0, 16 - n, 8);
    else if (n === 16) part(4, 0, 8, 8);
    else if (n <= 19) {
      context.globalAlpha = (n - 16) / 4;
      part(0, 0, 8, 8);
      context.globalAlpha = 1;
    } else if (n === 20) part(0, 0, 8, 1);
    else if (n === 21) part(7, 0, 8, 8);
    else {
      const quarters = [4, 8, 1, 13, 9, 7, 11, 2, 6, 14][n - 22];  // 1 upper left, 2 upper right, 4 lower left, 8 lower right
      if (quarters & 1) part(0, 0, 4, 4);
      if (quarters & 2) part(4, 0, 8, 4);
      if (quarters & 4) part(0, 4, 4, 8);
      if (quarters & 8) part(4, 4, 8, 8);
    }
    return true;
  }

  drawBraille(context, code) {
    const {cell, line} = this;
    const size = Math.max(1, Math.round(Math.min(cell / 4, line / 8)));
    // Bits 0 to 2 and 6 go down the left column, 3 to 5 and 7 down the right one.
    [0, 1, 2, 6, 3, 4, 5, 7].forEach((bit, i) => {
      if ((code >> bit & 1) === 0) return;
      const centreX = Math.round(cell * (i < 4 ? 0.25 : 0.75));
      const centreY = Math.round(line * (2 * (i % 4) + 1) / 8);
      context.fillRect(centreX - (size >> 1), centreY - (size >> 1), size, size);
    });
    return true;
  }
}
