# Four bytes per texel are texels, though (1, 1, 1, 128) looks like a run of the old kind: 1/256 everywhere.
{ printf '#?RADIANCE\n\n-Y 1 +X 4\n'; for i in 1 2 3 4; do printf '\001\001\001\200'; done; } >flat.hdr
{ printf 'PF\n4 1\n-1\n'; for i in 1 2 3 4 5 6 7 8 9 10 11 12; do printf '\000\000\200\073'; done; } >right.pfm
expect 0 compare right.pfm flat.hdr --max differing=0
