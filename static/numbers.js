/** Numbers as people type and read them. */

const MINUS = "\u2212";
const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)$/;

/**
 * A number as typed: a decimal comma and a real minus sign are understood; thousands
 * separators and exponents are not, because a slip there moves a robot far.
 *
 * @param {string} text
 * @returns {number | null} null when the text is no such number
 */
export function parseNumber(text) {
  const plain = text.trim().replaceAll(MINUS, "-").replace(",", ".");
  return NUMBER.test(plain) ? Number(plain) : null;
}

/**
 * @param {number | null | undefined} value
 * @param {number} digits after the point
 * @returns {string} with a real minus sign, never "-0.00"; a dash when unknown
 */
export function formatNumber(value, digits) {
  if (value === null || value === undefined) return "–";
  const text = Math.abs(value).toFixed(digits);
  return value < 0 && Number(text) !== 0 ? MINUS + text : text;
}

/**
 * @param {number | null | undefined} share 1 is all of it
 * @returns {string}
 */
export function formatShare(share) {
  return share === null || share === undefined ? "–" : `${Math.round(Math.abs(share) * 100)} %`;
}
