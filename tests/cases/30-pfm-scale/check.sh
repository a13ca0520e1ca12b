# A PFM file of ones with the scale 2.5.
{ printf 'PF\n1 1\n-2.5\n'; for i in 1 2 3; do printf '\000\000\200\077'; done; } >scale.pfm
{ printf 'PF\n1 1\n-1\n'; for i in 1 2 3; do printf '\000\000\040\100'; done; } >right.pfm
expect 0 compare right.pfm scale.pfm --max differing=0
# A Radiance file of ones whose COLORCORR is (2, 1, 0.5).
printf '#?RADIANCE\nCOLORCORR=2 1 0.5\n\n-Y 1 +X 1\n\200\200\200\201' >colorcorr.hdr
printf 'PF\n1 1\n-1\n\000\000\000\077\000\000\200\077\000\000\000\100' >right.pfm
expect 0 compare right.pfm colorcorr.hdr --max differing=0
