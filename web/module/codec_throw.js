// codec_throw.js - names the function that codec_throw.cc imports and element/codecs.js gives.
mergeInto(LibraryManager.library, { codec_throw: function () {} });
