"""The motion itself: histories over many periods, Floquet modes, who takes part in what."""
