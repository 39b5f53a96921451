// What the pages have besides our modules: the vendored library, the reader of columns, and what a browser has.
declare const THREE: any;
declare const DecompressionStream: any;
declare function unpack(id: string): Promise<Int32Array>;
