// The largest number that 16 bits hold: more would be infinite, and nothing of it no number.
const MOST_LIGHT = 65504.0;
