# Red and green in two slices of ETC1S: toktx's swizzle ra01 names the second one where transcoders put it, in alpha.
expect 0 compare "$case_dir/rg.ktx2" "$case_dir/rg_swizzle_ra01.ktx2" --max differing=0
