/* shadow.frag - what casts a shadow: its depth, and of masked materials the texels that are there. */
void main()
{
#ifdef HAS_ALPHA_MASK
    if (coverage(base_color().w) < 0.5)
        discard;
#endif
}
