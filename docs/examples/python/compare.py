"""How far two renderers are apart: compare.py MODEL IMAGE"""
import sys

import facet

scene = facet.load(sys.argv[1])
preview = scene.render(size=320)
paths = scene.render(size=320, renderer="path", samples=32, path={"denoises": True})
comparison = facet.compare(paths, preview, space="display", difference="heat-map", is_sheet=True)
print(f"FLIP {comparison.flip:.4f}, PSNR {comparison.psnr:.1f} dB, SSIM {comparison.ssim:.4f}")
comparison.difference.save(sys.argv[2])
