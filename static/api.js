/** Calls to the HTTP API. A refusal is thrown with the server's own words. */

export class Refusal extends Error {}

const TIMEOUT_MS = 10_000;

/**
 * @param {string} path below /api/
 * @returns {Promise<any>}
 */
export async function get(path) {
  return call(path, { cache: "no-store" });
}

/**
 * @param {string} path below /api/
 * @param {object} [body]
 * @returns {Promise<any>}
 */
export async function post(path, body) {
  return call(path, {
    method: "POST",
    ...(body && { body: JSON.stringify(body), headers: { "Content-Type": "application/json" } }),
  });
}

/**
 * @param {string} path
 * @param {RequestInit} options
 */
async function call(path, options) {
  const response = await fetch(`/api/${path}`, {
    signal: AbortSignal.timeout(TIMEOUT_MS),
    ...options,
  }).catch(() => {
    throw new Refusal("The server does not answer.");
  });
  const answer = await response.json().catch(() => null);
  if (!response.ok) throw new Refusal(detail(answer) ?? `The server answered ${response.status}.`);
  return answer;
}

/** @param {unknown} answer */
function detail(answer) {
  const text = /** @type {{detail?: unknown} | null} */ (answer)?.detail;
  return typeof text === "string" ? text : null;
}
