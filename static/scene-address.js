/**
 * Where the scene is loaded from.
 *
 * A computer without a graphics card draws on its processor, and the page's main thread waits
 * for every picture: with a quarter of the pixels there are several times as many pictures, and
 * signs of life from what is held are not late.
 */

const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;
const COARSE = 0.5; // pixels drawn for each pixel of the page, along an edge

export function sceneAddress() {
  return drawsInSoftware() ? `/scene/?fixedDpr=${COARSE}` : "/scene/";
}

function drawsInSoftware() {
  const context = document.createElement("canvas").getContext("webgl2");
  const info = context?.getExtension("WEBGL_debug_renderer_info");
  const renderer = info ? String(context?.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return SOFTWARE.test(renderer);
}
