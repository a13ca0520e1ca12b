# vignette.R - the computation of rgl2gltf's vignette "Shininess in OpenGL 1 versus glTF PBR", beside facet's:
#     facet plot legacy --heaviside ramp -o vignette.csv
#     Rscript vignette.R vignette.csv
# prints how far the two are apart (and fails where that is more than rounding).
curves <- function(roughness = 1, m = 1, Cd = 1, s = 50, Cs = 1, theta = 30 * pi / 180) {
  phi <- seq(-80, 80, by = 5) * pi / 180
  alpha <- roughness^2
  V <- c(sin(theta), 0, cos(theta))
  t(sapply(phi, function(p) {
    L <- c(sin(p), 0, cos(p))
    H <- (L + V) / sqrt(sum((L + V)^2))
    VdotN <- V[3]; NdotL <- L[3]; HdotN <- H[3]
    HdotL <- sum(H * L); HdotV <- sum(H * V)
    D <- (1 / pi) * alpha^2 * max(0, HdotN) / (HdotN^2 * (alpha^2 - 1) + 1)^2
    G <- 2 * NdotL * max(HdotL, 0) * 2 * VdotN * max(HdotV, 0) /
      (NdotL + sqrt(alpha^2 + (1 - alpha^2) * NdotL^2)) / (VdotN + sqrt(alpha^2 + (1 - alpha^2) * VdotN^2))
    f0 <- 0.04 * (1 - m) + m * Cd
    F <- f0 + (1 - f0) * (1 - HdotV)^5
    f_diffuse <- (1 / pi) * (1 - F) * (1 - m) * Cd
    f_specular <- F * D * G / 4 / abs(VdotN) / abs(NdotL)
    c(phi = p, PBR = (f_diffuse + f_specular) * NdotL, OGL1 = max(NdotL, 0) * Cd + max(HdotN, 0)^s * Cs)
  }))
}

# facet's file has one table after the other, each under comments.
read_tables <- function(file) {
  lines <- readLines(file)
  is_row <- nzchar(lines) & !startsWith(lines, "#")
  lapply(split(lines[is_row], cumsum(!is_row)[is_row]), function(rows) read.csv(text = rows, check.names = FALSE))
}

ours <- curves()
tables <- read_tables(commandArgs(TRUE)[1])
PBR <- tables[[1]][[2]]
OGL1 <- tables[[2]][[2]]
stopifnot(length(PBR) == nrow(ours), length(OGL1) == nrow(ours))
difference <- c(phi = max(abs(tables[[1]][[1]] - ours[, "phi"])), PBR = max(abs(PBR - ours[, "PBR"])),
                OGL1 = max(abs(OGL1 - ours[, "OGL1"])))
print(difference)
stopifnot(difference < 1e-12)
