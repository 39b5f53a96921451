/* The reverse of column_encoding.py: base64, deflate, bytes sorted by place, differences of 32-bit words. */
async function unpack(id) {
  const element = document.getElementById(id);
  const text = atob(element.textContent);
  element.remove();
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const places = new Uint8Array(await new Response(stream).arrayBuffer());
  const n = places.length / 4;
  const words = new Int32Array(n);
  for (let i = 0, word = 0; i < n; i++) {
    word = (word + (places[i] | (places[n + i] << 8) | (places[2 * n + i] << 16) | (places[3 * n + i] << 24))) | 0;
    words[i] = word;
  }
  return words;
}
