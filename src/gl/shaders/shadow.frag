/* shadow.frag - shadow casters: their depth, and for masked materials the alpha test. */
void main()
{
#ifdef HAS_ALPHA_MASK
    read_texels();
    if (coverage(base_color().w) < 0.5)
        discard;
#endif
}
