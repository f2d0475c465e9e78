// SPDX-License-Identifier: Apache-2.0
// What tests look at in a page.

// What a picture of part of the page holds: the share of pixels unlike the first one, and the number of colours.
export async function contentOf(page, selector) {
  const png = await page.locator(selector).screenshot();
  return page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = new OffscreenCanvas(image.width, image.height), context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const pixels = new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer);
    return { share: pixels.filter((pixel) => pixel !== pixels[0]).length / pixels.length,
             colors: new Set(pixels).size };
  }, png.toString("base64"));
}

// A list that gets the page's errors as they come.
export function gatherErrors(page) {
  const errors = [];
  page.on("pageerror", (error) => errors.push(error.message));
  page.on("console", (message) => {
    // Chromium itself says that a server is gone, which here it is for a while.
    const serverIsGone = /WebSocket connection .* failed/.test(message.text());
    if (message.type() === "error" && !serverIsGone) errors.push(message.text());
  });
  return errors;
}
