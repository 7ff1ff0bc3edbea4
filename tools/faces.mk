# faces.mk: `make test-faces`: what krs has for other programs, editors and languages, used as its users would (try-faces.sh).

test-faces: all
	@tools/deps.sh faces
	@tools/try-faces.sh $(B) $(B)/faces
.PHONY: test-faces
