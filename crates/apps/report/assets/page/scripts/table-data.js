// The cells of the table, which the page holds packed.

/** Unpacks the cells: of each column of numbers all first bytes, then all second ones, as in the file; and columns with texts. */
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
