// error.js - what every function of the package throws: one sentence that names the file, the place and what was expected.
export class FacetError extends Error {
  // code: the exit code of the command `facet`, or 0 where there is none.
  constructor(message, code = 0) {
    super(message);
    this.name = 'FacetError';
    this.code = code;
  }
}
