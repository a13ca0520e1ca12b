export * from './tools.js';

/** All files in and below folder, by their paths in it; only is a test of a path. */
export function readFolder(folder: string, only?: (path: string) => boolean): Promise<Record<string, Uint8Array>>;

/** Writes files below folder; missing folders are made. */
export function writeFiles(folder: string, files: Record<string, Uint8Array>): Promise<void>;
