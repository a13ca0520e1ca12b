/* lang_c_undef.h - ends the meanings of the functions that the C library has, too, whichever were in force:
 * those of the dialect or the type-generic ones. Included by lang_c_begin.h and lang_c_end.h, each time. */
#undef abs
#undef sqrt
#undef exp
#undef log
#undef exp2
#undef log2
#undef floor
#undef pow
#undef sin
#undef cos
#undef tan
#undef asin
#undef acos
#undef atan
