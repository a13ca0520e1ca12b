/* lang_cxx_end.h - closes the namespace that lang_cxx.h opens around the shader library. */
} /* namespace facet */
} /* extern "C++" */
