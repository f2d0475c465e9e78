// SPDX-License-Identifier: Apache-2.0
// Places for labels, so that none covers another.

export class LabelPlaces {
  constructor() { this.taken = []; }

  // The number of rows by which a label that wants this place (left, top, size) has to be moved, each `step` down
  // (negative: up), to cover no other; then it is taken. Undefined if none of the first `rows` is free.
  take(left, top, width, height, step, rows) {
    for (let row = 0; row < rows; ++row) {
      const place = [left, top + row * step, left + width, top + row * step + height];
      if (this.taken.some((other) => overlap(place, other))) continue;
      this.taken.push(place);
      return row;
    }
    return undefined;
  }
}

function overlap(a, b) {
  return a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
}
