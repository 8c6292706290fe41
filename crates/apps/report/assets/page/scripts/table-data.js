// The cells of the table, packed in the page.

// Unpacks the cells. Each numeric column holds the first bytes of all numbers, then the second
// bytes, and so on. Text columns are JSON.
squama.unpack = async () => {
  const [numbers, texts] = await Promise.all([squama.unpacked("cells").arrayBuffer(), squama.unpacked("texts").json()]);
  const bytes = new Uint8Array(numbers), { count } = squama;
  let at = 0;
  squama.values = squama.columns.map(({ name }) => {
    if (texts[name]) return texts[name];
    const own = new Uint8Array(8 * count);
    for (let byte = 0; byte < 8; byte++) for (let row = 0; row < count; row++) own[8 * row + byte] = bytes[at++];
    return new Float64Array(own.buffer);
  });
};
