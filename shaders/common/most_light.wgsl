// Largest number in 16-bit floats: larger ones become infinite, and products of infinity and zero NaN.
const MAX_HALF_FLOAT = 65504.0;
