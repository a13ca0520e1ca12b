/** The content of a file. */
export type FileData = Uint8Array | ArrayBuffer | ArrayBufferView | string;

/** Files by path, relative and with "/" ("textures/wood.png"). Models find their buffers and textures among them. */
export type Files = Record<string, FileData>;

/** Long options of the command, as {output: 'a.glb', maxTexture: 512} or {'max-texture': 512}; a flag is true. */
export type Options = Record<string, string | number | boolean | null | undefined | ReadonlyArray<string | number>>;

export interface RunResult {
  /** The exit code of the command: 0, or 1 where the answer is no, or 2 and more after an error. */
  code: number;
  stdout: string;
  /** Standard output as bytes, for `-o -`. */
  stdoutBytes: Uint8Array;
  /** Warnings and errors, one sentence in a line. */
  stderr: string;
  /** The files that were written. */
  files: Record<string, Uint8Array>;
}

export interface Made {
  files: Record<string, Uint8Array>;
  warnings: string[];
}

/** The command `facet` over files in memory. Calls wait for each other; a second object of loadTools() works beside. */
export interface Tools {
  /** The version, as "0.2.0". */
  version(): Promise<string>;
  /** Any command line, as run(['convert', 'a.obj', 'b.glb'], {'a.obj': bytes}). Rejects only if WebAssembly stops. */
  run(args: ReadonlyArray<string | number>, files?: Files, input?: { stdin?: FileData }): Promise<RunResult>;
  /** What `facet inspect --json` prints. Rejects with a FacetError, as all functions below. */
  inspect(files: Files, path: string, options?: Options): Promise<any>;
  /** `facet convert path`; options.output names the new model. */
  convert(files: Files, path: string, options: Options & { output: string }): Promise<Made>;
  /** `facet bake path`; path is a file, the name of a sky ("sun:45,135") or null for tables (options.dfg). */
  bake(files: Files, path: string | null, options: Options): Promise<Made>;
  /** `facet plot kind` with materials as "roughness=0.3,metallic=1", files among them: the drawing, and fits where options.fit is true. */
  plot(kind: string, materials?: ReadonlyArray<string>, options?: Options, files?: Files): Promise<{ svg: string; fits: any[] }>;
  /** The numbers of the same plot: title, width, height, and panels with their curves and places in the drawing. */
  plotData(kind: string, materials?: ReadonlyArray<string>, options?: Options, files?: Files): Promise<any>;
  /**
   * The model at path as .glb with edited materials: {0: {pbrMetallicRoughness: {roughnessFactor: 0.3}}}. Named members replace
   * values, null removes one; of a glTF file all else stays as it is.
   */
  save(files: Files, path: string, edits?: Record<number, object>): Promise<Uint8Array>;
  /** What `facet compare a b --json` prints, and the image of the difference among files. */
  compare(files: Files, a: string, b: string, options?: Options): Promise<any>;
}

/** One sentence that names the file, the place and what was expected. */
export class FacetError extends Error {
  constructor(message: string, code?: number);
  /** The exit code of the command; 0: none. */
  readonly code: number;
}

/** wasm: facet-command.wasm as bytes or compiled, in place of the file beside this one. */
export function loadTools(options?: { wasm?: BufferSource | WebAssembly.Module }): Promise<Tools>;
