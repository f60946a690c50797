"""F, G and H of the report's two beams in closed form: modes, their integrals, one file a beam."""
