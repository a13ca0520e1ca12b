# A million instances of which the file gives none: one is drawn, in no more than its memory and time.
expect 0 render $small --max-memory 200MiB --time-limit 5 "$case_dir/inst1m_boxes.glb" -o x.png
says "1000000 instances without data are in one place; one is drawn"
[ -s x.png ] || failed "no image"
