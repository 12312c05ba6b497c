"""Records and variants of the scene language; written by `generate.py`, do not edit."""

# ruff: noqa
# mypy: disable-error-code="misc,override,attr-defined,assignment"
from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from ._model import Array, Choice, Record, Unset, Variant, _CLASSES, _TYPES, _VARIANTS, _variant_holds, _variant_keys


class Include(Record):
    """A file whose definitions are part of the scene, by names that start with the include's own: `birch.leaf`. In place of `(file: "species/birch.ron")`, `"species/birch.ron"` will do."""

    __slots__ = ()
    _ron = ""

    file: str
    """Path, relative to the file that includes it."""
    params: dict[str, float | str]
    """Values for its `params`; they go before the file's own and before its variant's."""
    variant: str | None
    """The variant of the file that is meant."""

    def __init__(self, *, file: str | Unset = ..., params: Mapping[str, float | str] | Unset = ..., variant: str | None | Unset = ...) -> None:
        super().__init__(file=file, params=params, variant=variant)

Include._keys = {key['name']: key for key in _TYPES["Include"]["x-keys"]}

_CLASSES["Include"] = Include


class Frame(Record):
    """Anchor of the local frame."""

    __slots__ = ()
    _ron = ""

    origin_m: tuple[float | str, float | str, float | str]
    """Easting, northing and height (UTM, say) of the local origin, m. Results do not depend on it."""
    crs: str | None
    """Coordinate reference system of `origin_m`: a projected one in metres, by its number, such as `"EPSG:32632"`. Rasters and polygons must be in it, and images say so. Without it, it is that of the first file that names one."""

    def __init__(self, *, origin_m: tuple[float | str, float | str, float | str] | Array | Unset = ..., crs: str | None | Unset = ...) -> None:
        super().__init__(origin_m=origin_m, crs=crs)

Frame._keys = {key['name']: key for key in _TYPES["Frame"]["x-keys"]}

_CLASSES["Frame"] = Frame


class Band(Record):
    """A spectral band."""

    __slots__ = ()
    _ron = ""

    name: str
    """Its name in all outputs."""
    center_nm: float | str | None
    """Centre wavelength of `Box` and `Gaussian`, nm. Bands of curves have that of their centroid without it."""
    width_nm: float | str
    """Full width of `Box`, nm, 0 means the centre wavelength alone; full width at half maximum of `Gaussian`."""
    response: Response
    """Relative response to the wavelengths: values of the band are means weighted with it."""
    source: BandSource
    """Sources of its radiance."""

    def __init__(self, *, name: str | Unset = ..., center_nm: float | str | None | Unset = ..., width_nm: float | str | Unset = ..., response: Response | Unset = ..., source: BandSource | Unset = ...) -> None:
        super().__init__(name=name, center_nm=center_nm, width_nm=width_nm, response=response, source=source)

Band._keys = {key['name']: key for key in _TYPES["Band"]["x-keys"]}

_CLASSES["Band"] = Band


class Response(Choice):
    """Relative response of a band to the wavelengths. Irradiances are averaged with it; reflectances and transmittances in all but a `Box` with the product of it and the sun's irradiance, where that is a spectrum (`Constant` and `Bands` have no wavelengths): then reflectance times irradiance is what is reflected."""

    __slots__ = ()

    Box: ClassVar[type[ResponseBox]]
    Gaussian: ClassVar[type[Gaussian]]
    Points: ClassVar[type[ResponsePoints]]
    Table: ClassVar[type[ResponseTable]]
    Sensor: ClassVar[type[ResponseSensor]]

_CLASSES["Response"] = Response
_VARIANTS["Response"] = {}


class ResponseBox(Response, Variant):
    """Alike from `center_nm - width_nm / 2` to `center_nm + width_nm / 2`."""

    __slots__ = ()
    _ron = "Box"

Response.Box = _VARIANTS["Response"]["Box"] = ResponseBox


class Gaussian(Response, Variant):
    """Normal curve around `center_nm` whose full width at half maximum is `width_nm`."""

    __slots__ = ()
    _ron = "Gaussian"

Response.Gaussian = _VARIANTS["Response"]["Gaussian"] = Gaussian


class ResponsePoints(Response, Variant):
    """Points (wavelength nm, relative response), joined by straight lines; 0 beyond."""

    __slots__ = ()
    _ron = "Points"

    value: list[tuple[float | str, float | str]]

    def __init__(self, value: list[tuple[float | str, float | str]] | Array, /) -> None:
        super().__init__(value)

ResponsePoints._holds = _variant_holds("Response", "Points")
ResponsePoints._keys = {"value": {"schema": ResponsePoints._holds, "default": None}}

Response.Points = _VARIANTS["Response"]["Points"] = ResponsePoints


class ResponseTable(Response, Variant):
    """Points from a file, as those of a spectrum."""

    __slots__ = ()
    _ron = "Table"

    file: str
    """Path, relative to the scene file."""
    wavelength: str | None
    """Header of the column of wavelengths; if absent, `wavelength_nm`, or the first column whose name says that it holds wavelengths."""
    value: str | None
    """Header of the column of values, or name of the spectrum in a library; if absent, the second column of the file, or its only spectrum."""
    wavelength_unit: WavelengthUnit | None
    """Unit of the wavelengths; if absent, that which the file names. A file that names none is refused without it."""
    wavelengths: str | None
    """File of the wavelengths of a spectrum of the USGS library, whose own file has none."""

    def __init__(self, *, file: str | Unset = ..., wavelength: str | None | Unset = ..., value: str | None | Unset = ..., wavelength_unit: WavelengthUnit | None | Unset = ..., wavelengths: str | None | Unset = ...) -> None:
        super().__init__(file=file, wavelength=wavelength, value=value, wavelength_unit=wavelength_unit, wavelengths=wavelengths)

ResponseTable._keys = {key['name']: key for key in _variant_keys("Response", "Table")}

Response.Table = _VARIANTS["Response"]["Table"] = ResponseTable


class ResponseSensor(Response, Variant):
    """A band of a sensor that sunfleck knows: their names."""

    __slots__ = ()
    _ron = "Sensor"

    value: tuple[str, str]

    def __init__(self, value_1: str, value_2: str, /) -> None:
        super().__init__(value_1, value_2)

ResponseSensor._holds = _variant_holds("Response", "Sensor")
ResponseSensor._keys = {"value": {"schema": ResponseSensor._holds, "default": None}}

Response.Sensor = _VARIANTS["Response"]["Sensor"] = ResponseSensor


class WavelengthUnit(Choice):
    """Unit of the wavelengths in a table."""

    __slots__ = ()

    Nanometres: ClassVar[type[Nanometres]]
    Micrometres: ClassVar[type[Micrometres]]
    Angstroms: ClassVar[type[Angstroms]]
    Wavenumbers: ClassVar[type[Wavenumbers]]

_CLASSES["WavelengthUnit"] = WavelengthUnit
_VARIANTS["WavelengthUnit"] = {}


class Nanometres(WavelengthUnit, Variant):
    """nm."""

    __slots__ = ()
    _ron = "Nanometres"

WavelengthUnit.Nanometres = _VARIANTS["WavelengthUnit"]["Nanometres"] = Nanometres


class Micrometres(WavelengthUnit, Variant):
    """µm, 1000 nm."""

    __slots__ = ()
    _ron = "Micrometres"

WavelengthUnit.Micrometres = _VARIANTS["WavelengthUnit"]["Micrometres"] = Micrometres


class Angstroms(WavelengthUnit, Variant):
    """Å, 0.1 nm."""

    __slots__ = ()
    _ron = "Angstroms"

WavelengthUnit.Angstroms = _VARIANTS["WavelengthUnit"]["Angstroms"] = Angstroms


class Wavenumbers(WavelengthUnit, Variant):
    """Waves per cm: 10⁷ nm over their number is the wavelength."""

    __slots__ = ()
    _ron = "Wavenumbers"

WavelengthUnit.Wavenumbers = _VARIANTS["WavelengthUnit"]["Wavenumbers"] = Wavenumbers


class BandSource(Choice):
    """Sources of the radiance in a band."""

    __slots__ = ()

    Auto: ClassVar[type[Auto]]
    Sunlight: ClassVar[type[Sunlight]]
    Emission: ClassVar[type[Emission]]
    Both: ClassVar[type[Both]]

_CLASSES["BandSource"] = BandSource
_VARIANTS["BandSource"] = {}


class Auto(BandSource, Variant):
    """Sun and sky up to 3000 nm, `Emission` where the centre lies beyond."""

    __slots__ = ()
    _ron = "Auto"

BandSource.Auto = _VARIANTS["BandSource"]["Auto"] = Auto


class Sunlight(BandSource, Variant):
    """Reflected light of sun and sky alone."""

    __slots__ = ()
    _ron = "Sunlight"

BandSource.Sunlight = _VARIANTS["BandSource"]["Sunlight"] = Sunlight


class Emission(BandSource, Variant):
    """Emission of surfaces and of `thermal_sky`, with its reflections, alone."""

    __slots__ = ()
    _ron = "Emission"

BandSource.Emission = _VARIANTS["BandSource"]["Emission"] = Emission


class Both(BandSource, Variant):
    """Their sum; for 3 to 5 µm by day."""

    __slots__ = ()
    _ron = "Both"

BandSource.Both = _VARIANTS["BandSource"]["Both"] = Both


class BandSet(Choice):
    """Bands of a whole sensor, in place of a list."""

    __slots__ = ()

    Sensor: ClassVar[type[BandSetSensor]]
    Hyperspectral: ClassVar[type[Hyperspectral]]

_CLASSES["BandSet"] = BandSet
_VARIANTS["BandSet"] = {}


class BandSetSensor(BandSet, Variant):
    """Bands of a sensor that sunfleck knows, by its name and theirs; all of them if the list is empty. Published curves of `Sentinel-2A MSI`, `Sentinel-2B MSI`, `Landsat 5 TM`, `Landsat 7 ETM+`, `Landsat 8 OLI`, `Landsat 8 TIRS`, `Landsat 9 OLI-2`, `Landsat 9 TIRS-2`, `Terra MODIS`, `Aqua MODIS`, `Terra ASTER` and `RapidEye MSI`; nominal boxes of `Sentinel-2C MSI`; normal curves of `EnMAP HSI` (widths are approximate) and `PRISMA HYC`."""

    __slots__ = ()
    _ron = "Sensor"

    value: tuple[str, list[str]]

    def __init__(self, value_1: str, value_2: list[str] | Array, /) -> None:
        super().__init__(value_1, value_2)

BandSetSensor._holds = _variant_holds("BandSet", "Sensor")
BandSetSensor._keys = {"value": {"schema": BandSetSensor._holds, "default": None}}

BandSet.Sensor = _VARIANTS["BandSet"]["Sensor"] = BandSetSensor


class Hyperspectral(BandSet, Variant):
    """Normal curves at even steps, named by their centres: `"700nm"`."""

    __slots__ = ()
    _ron = "Hyperspectral"

    from_nm: float | str
    """Centre of the first band, nm."""
    to_nm: float | str
    """Centre of the last band, nm, or a little more."""
    step_nm: float | str
    """Distance of centres, nm."""
    fwhm_nm: float | str
    """Full width at half maximum, nm."""

    def __init__(self, *, from_nm: float | str | Unset = ..., to_nm: float | str | Unset = ..., step_nm: float | str | Unset = ..., fwhm_nm: float | str | Unset = ...) -> None:
        super().__init__(from_nm=from_nm, to_nm=to_nm, step_nm=step_nm, fwhm_nm=fwhm_nm)

Hyperspectral._keys = {key['name']: key for key in _variant_keys("BandSet", "Hyperspectral")}

BandSet.Hyperspectral = _VARIANTS["BandSet"]["Hyperspectral"] = Hyperspectral


class Spectrum(Choice):
    """A quantity as a function of wavelength, or given band by band."""

    __slots__ = ()

    Constant: ClassVar[type[Constant]]
    Bands: ClassVar[type[SpectrumBands]]
    Points: ClassVar[type[SpectrumPoints]]
    Table: ClassVar[type[SpectrumTable]]
    AstmG173: ClassVar[type[AstmG173]]
    AstmE490: ClassVar[type[AstmE490]]
    Library: ClassVar[type[Library]]
    Soil: ClassVar[type[Soil]]
    Named: ClassVar[type[Named]]
    Prospect: ClassVar[type[Prospect]]

_CLASSES["Spectrum"] = Spectrum
_VARIANTS["Spectrum"] = {}


class Constant(Spectrum, Variant):
    """One value for all wavelengths."""

    __slots__ = ()
    _ron = "Constant"

    value: float | str

    def __init__(self, value: float | str, /) -> None:
        super().__init__(value)

Constant._holds = _variant_holds("Spectrum", "Constant")
Constant._keys = {"value": {"schema": Constant._holds, "default": None}}

Spectrum.Constant = _VARIANTS["Spectrum"]["Constant"] = Constant


class SpectrumBands(Spectrum, Variant):
    """One value for each band of this scene."""

    __slots__ = ()
    _ron = "Bands"

    value: list[float | str]

    def __init__(self, value: list[float | str] | Array, /) -> None:
        super().__init__(value)

SpectrumBands._holds = _variant_holds("Spectrum", "Bands")
SpectrumBands._keys = {"value": {"schema": SpectrumBands._holds, "default": None}}

Spectrum.Bands = _VARIANTS["Spectrum"]["Bands"] = SpectrumBands


class SpectrumPoints(Spectrum, Variant):
    """Points (wavelength nm, value), joined by straight lines and averaged over each band."""

    __slots__ = ()
    _ron = "Points"

    value: list[tuple[float | str, float | str]]

    def __init__(self, value: list[tuple[float | str, float | str]] | Array, /) -> None:
        super().__init__(value)

SpectrumPoints._holds = _variant_holds("Spectrum", "Points")
SpectrumPoints._keys = {"value": {"schema": SpectrumPoints._holds, "default": None}}

Spectrum.Points = _VARIANTS["Spectrum"]["Points"] = SpectrumPoints


class SpectrumTable(Spectrum, Variant):
    """Points of a spectrum in a file: a CSV file or a spectral library."""

    __slots__ = ()
    _ron = "Table"

    file: str
    """Path, relative to the scene file."""
    wavelength: str | None
    """Header of the column of wavelengths; if absent, `wavelength_nm`, or the first column whose name says that it holds wavelengths."""
    value: str | None
    """Header of the column of values, or name of the spectrum in a library; if absent, the second column of the file, or its only spectrum."""
    wavelength_unit: WavelengthUnit | None
    """Unit of the wavelengths; if absent, that which the file names. A file that names none is refused without it."""
    wavelengths: str | None
    """File of the wavelengths of a spectrum of the USGS library, whose own file has none."""
    unit: ValueUnit | None
    """Unit of reflectances and transmittances; if absent, percent where the file says so, else fractions. A file with values that are none is refused without it."""
    scale: float | str
    """Factor on all values: 0.0001 for reflectances that are kept as 0 to 10000, 0.001 for an irradiance in W m⁻² µm⁻¹."""

    def __init__(self, *, file: str | Unset = ..., wavelength: str | None | Unset = ..., value: str | None | Unset = ..., wavelength_unit: WavelengthUnit | None | Unset = ..., wavelengths: str | None | Unset = ..., unit: ValueUnit | None | Unset = ..., scale: float | str | Unset = ...) -> None:
        super().__init__(file=file, wavelength=wavelength, value=value, wavelength_unit=wavelength_unit, wavelengths=wavelengths, unit=unit, scale=scale)

SpectrumTable._keys = {key['name']: key for key in _variant_keys("Spectrum", "Table")}

Spectrum.Table = _VARIANTS["Spectrum"]["Table"] = SpectrumTable


class AstmG173(Spectrum, Variant):
    """Irradiance of the sun and of the 2.9° around it on a plane that faces it, under a clear sky at air mass 1.5: 280 to 4000 nm.  Source: ASTM G173-03, direct + circumsolar."""

    __slots__ = ()
    _ron = "AstmG173"

Spectrum.AstmG173 = _VARIANTS["Spectrum"]["AstmG173"] = AstmG173


class AstmE490(Spectrum, Variant):
    """Irradiance of the sun outside the atmosphere at its mean distance, on a plane that faces it: 119.5 nm to 1 mm.  Source: ASTM E490-00a."""

    __slots__ = ()
    _ron = "AstmE490"

Spectrum.AstmE490 = _VARIANTS["Spectrum"]["AstmE490"] = AstmE490


class Library(Spectrum, Variant):
    """Reflectance that comes with sunfleck, 400 to 2450 nm or more: `litter_douglas_fir`, `litter_ponderosa_pine`, `litter_lodgepole_pine`, `litter_subalpine_fir`, `litter_needles`, `litter_mixed`, `litter_cottonwood`, `litter_fern`, `grass_dead`, `grass_golden`, `bark_birch`, `bark_aspen`, `bark_spruce`, `bark_dead`, `twig_dead`, `wood_old`, `wood_stump`, `wood_bleached`, `soil_charred`, `bark_charred`, `ash` (measured; the Joint Fire Science Program by way of earthlib); `snow_fresh`, `snow_settled`, `snow_old`, `snow_wet` (computed for grains of 60, 20, 8 and 4 m² kg⁻¹; Kokhanovsky and Zege 2004)."""

    __slots__ = ()
    _ron = "Library"

    value: str

    def __init__(self, value: str, /) -> None:
        super().__init__(value)

Library._holds = _variant_holds("Spectrum", "Library")
Library._keys = {"value": {"schema": Library._holds, "default": None}}

Spectrum.Library = _VARIANTS["Spectrum"]["Library"] = Library


class Soil(Spectrum, Variant):
    """Reflectance of a soil, 400 to 2500 nm: a dry and a wet one, mixed.  Source: the soils of PROSAIL (Jacquemoud et al. 2009)."""

    __slots__ = ()
    _ron = "Soil"

    dryness: float | str
    """Share of the dry soil, 0 (wet) to 1 (dry)."""
    brightness: float | str
    """Factor on the reflectance, 0 to 2."""

    def __init__(self, *, dryness: float | str | Unset = ..., brightness: float | str | Unset = ...) -> None:
        super().__init__(dryness=dryness, brightness=brightness)

Soil._keys = {key['name']: key for key in _variant_keys("Spectrum", "Soil")}

Spectrum.Soil = _VARIANTS["Spectrum"]["Soil"] = Soil


class Named(Spectrum, Variant):
    """One of the scene's `spectra`."""

    __slots__ = ()
    _ron = "Named"

    value: str

    def __init__(self, value: str, /) -> None:
        super().__init__(value)

Named._holds = _variant_holds("Spectrum", "Named")
Named._keys = {"value": {"schema": Named._holds, "default": None}}

Spectrum.Named = _VARIANTS["Spectrum"]["Named"] = Named


class Prospect(Spectrum, Variant):
    """Leaf reflectance or transmittance (whichever the key asks for) by PROSPECT-PRO."""

    __slots__ = ()
    _ron = "Prospect"

    n: float | str
    """Leaf structure parameter N, 1 to 3."""
    chlorophyll_ug_cm2: float | str
    """Chlorophyll a + b, µg cm⁻²."""
    carotenoid_ug_cm2: float | str
    """Carotenoids, µg cm⁻²."""
    anthocyanin_ug_cm2: float | str
    """Anthocyanins, µg cm⁻²."""
    brown: float | str
    """Brown pigments, arbitrary units."""
    water_cm: float | str
    """Equivalent water thickness, cm."""
    dry_matter_g_cm2: float | str
    """Dry matter, g cm⁻²; 0 where proteins and other carbon are given instead."""
    protein_g_cm2: float | str
    """Proteins, g cm⁻²."""
    carbon_g_cm2: float | str
    """Carbon-based constituents other than proteins, g cm⁻²."""

    def __init__(self, *, n: float | str | Unset = ..., chlorophyll_ug_cm2: float | str | Unset = ..., carotenoid_ug_cm2: float | str | Unset = ..., anthocyanin_ug_cm2: float | str | Unset = ..., brown: float | str | Unset = ..., water_cm: float | str | Unset = ..., dry_matter_g_cm2: float | str | Unset = ..., protein_g_cm2: float | str | Unset = ..., carbon_g_cm2: float | str | Unset = ...) -> None:
        super().__init__(n=n, chlorophyll_ug_cm2=chlorophyll_ug_cm2, carotenoid_ug_cm2=carotenoid_ug_cm2, anthocyanin_ug_cm2=anthocyanin_ug_cm2, brown=brown, water_cm=water_cm, dry_matter_g_cm2=dry_matter_g_cm2, protein_g_cm2=protein_g_cm2, carbon_g_cm2=carbon_g_cm2)

Prospect._keys = {key['name']: key for key in _variant_keys("Spectrum", "Prospect")}

Spectrum.Prospect = _VARIANTS["Spectrum"]["Prospect"] = Prospect


class ValueUnit(Choice):
    """Unit of the reflectances or transmittances in a table."""

    __slots__ = ()

    Fraction: ClassVar[type[ValueUnitFraction]]
    Percent: ClassVar[type[Percent]]

_CLASSES["ValueUnit"] = ValueUnit
_VARIANTS["ValueUnit"] = {}


class ValueUnitFraction(ValueUnit, Variant):
    """Fractions from 0 to 1."""

    __slots__ = ()
    _ron = "Fraction"

ValueUnit.Fraction = _VARIANTS["ValueUnit"]["Fraction"] = ValueUnitFraction


class Percent(ValueUnit, Variant):
    """Percent from 0 to 100."""

    __slots__ = ()
    _ron = "Percent"

ValueUnit.Percent = _VARIANTS["ValueUnit"]["Percent"] = Percent


class Material(Choice):
    """A surface."""

    __slots__ = ()

    Lambertian: ClassVar[type[Lambertian]]
    Leaf: ClassVar[type[Leaf]]
    Rpv: ClassVar[type[Rpv]]
    Soilspect: ClassVar[type[Soilspect]]
    ReflectanceMap: ClassVar[type[ReflectanceMap]]

_CLASSES["Material"] = Material
_VARIANTS["Material"] = {}


class Lambertian(Material, Variant):
    """Reflects diffusely on both sides; opaque."""

    __slots__ = ()
    _ron = "Lambertian"

    reflectance: Spectrum
    """Reflectance of the front side, and of the back unless that is given."""
    back_reflectance: Spectrum | None
    """Reflectance of the back side."""
    temperature: Temperature | None
    """Temperature; needed where a sensor measures its emission."""

    def __init__(self, *, reflectance: Spectrum | Unset = ..., back_reflectance: Spectrum | None | Unset = ..., temperature: Temperature | None | Unset = ...) -> None:
        super().__init__(reflectance=reflectance, back_reflectance=back_reflectance, temperature=temperature)

Lambertian._keys = {key['name']: key for key in _variant_keys("Material", "Lambertian")}

Material.Lambertian = _VARIANTS["Material"]["Lambertian"] = Lambertian


class Leaf(Material, Variant):
    """Reflects and transmits diffusely."""

    __slots__ = ()
    _ron = "Leaf"

    reflectance: Spectrum
    """Reflectance of the front side, and of the back unless that is given."""
    transmittance: Spectrum
    """Transmittance, the same in both directions."""
    back_reflectance: Spectrum | None
    """Reflectance of the back side."""
    coating: Coating | None
    """Specular coating of both sides. Reflectance and transmittance are then those of the body beneath it."""
    temperature: Temperature | None
    """Temperature; needed where a sensor measures its emission."""

    def __init__(self, *, reflectance: Spectrum | Unset = ..., transmittance: Spectrum | Unset = ..., back_reflectance: Spectrum | None | Unset = ..., coating: Coating | None | Unset = ..., temperature: Temperature | None | Unset = ...) -> None:
        super().__init__(reflectance=reflectance, transmittance=transmittance, back_reflectance=back_reflectance, coating=coating, temperature=temperature)

Leaf._keys = {key['name']: key for key in _variant_keys("Material", "Leaf")}

Material.Leaf = _VARIANTS["Material"]["Leaf"] = Leaf


class Rpv(Material, Variant):
    """Reflects by the model of Rahman, Pinty and Verstraete, on both sides; opaque. For soil, snow, or vegetation seen from afar.  Source: Rahman, Pinty & Verstraete (1993), J. Geophys. Res. 98 (D11), 20791–20801."""

    __slots__ = ()
    _ron = "Rpv"

    rho0: Spectrum
    """Amplitude ρ0."""
    k: Spectrum
    """Bowl shape k: below 1, reflectance rises towards the horizon."""
    asymmetry: Spectrum
    """Asymmetry Θ, -1 to 1: below 0, more is reflected back towards the light."""
    rho_c: Spectrum | None
    """Hot spot ρc: the smaller, the higher the hot spot; ρ0 if absent."""
    temperature: Temperature | None
    """Temperature; needed where a sensor measures its emission."""

    def __init__(self, *, rho0: Spectrum | Unset = ..., k: Spectrum | Unset = ..., asymmetry: Spectrum | Unset = ..., rho_c: Spectrum | None | Unset = ..., temperature: Temperature | None | Unset = ...) -> None:
        super().__init__(rho0=rho0, k=k, asymmetry=asymmetry, rho_c=rho_c, temperature=temperature)

Rpv._keys = {key['name']: key for key in _variant_keys("Material", "Rpv")}

Material.Rpv = _VARIANTS["Material"]["Rpv"] = Rpv


class Soilspect(Material, Variant):
    """Reflects by the SOILSPECT model, on both sides; opaque.  Source: Jacquemoud, Baret & Hanocq (1992), Remote Sens. Environ. 41, 123–132."""

    __slots__ = ()
    _ron = "Soilspect"

    albedo: Spectrum
    """Single-scattering albedo ω, 0 to 1."""
    roughness: Spectrum
    """Roughness h: the larger, the wider the hot spot."""
    hot_spot: Spectrum
    """Amplitude of the hot spot, 1 in the paper."""
    b: Spectrum
    """First Legendre coefficient of the phase angle, b."""
    c: Spectrum
    """Second Legendre coefficient of the phase angle, c."""
    b_prime: Spectrum
    """First Legendre coefficient of the angle to the mirror direction, b'."""
    c_prime: Spectrum
    """Second Legendre coefficient of the angle to the mirror direction, c'."""
    temperature: Temperature | None
    """Temperature; needed where a sensor measures its emission."""

    def __init__(self, *, albedo: Spectrum | Unset = ..., roughness: Spectrum | Unset = ..., hot_spot: Spectrum | Unset = ..., b: Spectrum | Unset = ..., c: Spectrum | Unset = ..., b_prime: Spectrum | Unset = ..., c_prime: Spectrum | Unset = ..., temperature: Temperature | None | Unset = ...) -> None:
        super().__init__(albedo=albedo, roughness=roughness, hot_spot=hot_spot, b=b, c=c, b_prime=b_prime, c_prime=c_prime, temperature=temperature)

Soilspect._keys = {key['name']: key for key in _variant_keys("Material", "Soilspect")}

Material.Soilspect = _VARIANTS["Material"]["Soilspect"] = Soilspect


class ReflectanceMap(Material, Variant):
    """Reflects diffusely on both sides, in each cell of a raster as much as its values say; opaque. For the terrain alone."""

    __slots__ = ()
    _ron = "ReflectanceMap"

    file: str
    """Raster: `GeoTIFF`, ENVI, Esri's `.bil` and `.flt`, or an ESRI ASCII grid; relative to the scene file."""
    bands: RasterBands
    """Bands of the raster that the bands of the scene have their reflectance from."""
    scale: float | str | None
    """Factor that makes fractions of the numbers in the file, in place of the file's own: 1.0 for fractions, 0.01 for percent, 0.0001 for reflectances that are kept as 0 to 10000. A file that says neither scale nor offset is refused without it."""
    offset: float | str
    """Number that is added to `scale` times the number in the file: -0.1 for products of Sentinel-2 since 2022."""
    elsewhere: Spectrum | None
    """Reflectance of cells without data and of ground beside the raster; both are errors without it."""
    temperature: Temperature | None
    """Temperature; needed where a sensor measures its emission."""

    def __init__(self, *, file: str | Unset = ..., bands: RasterBands | Unset = ..., scale: float | str | None | Unset = ..., offset: float | str | Unset = ..., elsewhere: Spectrum | None | Unset = ..., temperature: Temperature | None | Unset = ...) -> None:
        super().__init__(file=file, bands=bands, scale=scale, offset=offset, elsewhere=elsewhere, temperature=temperature)

ReflectanceMap._keys = {key['name']: key for key in _variant_keys("Material", "ReflectanceMap")}

Material.ReflectanceMap = _VARIANTS["Material"]["ReflectanceMap"] = ReflectanceMap


class Temperature(Choice):
    """A temperature, K."""

    __slots__ = ()

    Uniform: ClassVar[type[TemperatureUniform]]
    SunlitShaded: ClassVar[type[SunlitShaded]]
    MeanDelta: ClassVar[type[MeanDelta]]

_CLASSES["Temperature"] = Temperature
_VARIANTS["Temperature"] = {}


class TemperatureUniform(Temperature, Variant):
    """One temperature everywhere."""

    __slots__ = ()
    _ron = "Uniform"

    value: float | str

    def __init__(self, value: float | str, /) -> None:
        super().__init__(value)

TemperatureUniform._holds = _variant_holds("Temperature", "Uniform")
TemperatureUniform._keys = {"value": {"schema": TemperatureUniform._holds, "default": None}}

Temperature.Uniform = _VARIANTS["Temperature"]["Uniform"] = TemperatureUniform


class SunlitShaded(Temperature, Variant):
    """One where the sun's disc is visible from the point, on whichever side of the surface, and one where it is not: both sides of a sunlit leaf have its sunlit temperature. In the penumbra each counts by the visible fraction of the disc. `FourComponents` count by the side that is seen."""

    __slots__ = ()
    _ron = "SunlitShaded"

    sunlit_k: float | str
    """Temperature where the sun is visible from either side, K."""
    shaded_k: float | str
    """Temperature where it is visible from neither, K."""

    def __init__(self, *, sunlit_k: float | str | Unset = ..., shaded_k: float | str | Unset = ...) -> None:
        super().__init__(sunlit_k=sunlit_k, shaded_k=shaded_k)

SunlitShaded._keys = {key['name']: key for key in _variant_keys("Temperature", "SunlitShaded")}

Temperature.SunlitShaded = _VARIANTS["Temperature"]["SunlitShaded"] = SunlitShaded


class MeanDelta(Temperature, Variant):
    """Sunlit `mean_k + delta_k / 2`, shaded `mean_k - delta_k / 2`."""

    __slots__ = ()
    _ron = "MeanDelta"

    mean_k: float | str
    """Mean of the two, K."""
    delta_k: float | str
    """Sunlit less shaded, K."""

    def __init__(self, *, mean_k: float | str | Unset = ..., delta_k: float | str | Unset = ...) -> None:
        super().__init__(mean_k=mean_k, delta_k=delta_k)

MeanDelta._keys = {key['name']: key for key in _variant_keys("Temperature", "MeanDelta")}

Temperature.MeanDelta = _VARIANTS["Temperature"]["MeanDelta"] = MeanDelta


class Coating(Record):
    """Rough dielectric coating of a leaf, with the specular lobe of Cook & Torrance (1982)."""

    __slots__ = ()
    _ron = ""

    refractive_index: float | str
    """Real refractive index, 1.1 to 2."""
    roughness: float | str
    """Root mean square slope of the surface, 0.05 to 1: about 0.1 for glossy leaves, 0.5 for dull ones."""

    def __init__(self, *, refractive_index: float | str | Unset = ..., roughness: float | str | Unset = ...) -> None:
        super().__init__(refractive_index=refractive_index, roughness=roughness)

Coating._keys = {key['name']: key for key in _TYPES["Coating"]["x-keys"]}

_CLASSES["Coating"] = Coating


class RasterBands(Choice):
    """Bands of a raster that the bands of the scene have their values from."""

    __slots__ = ()

    All: ClassVar[type[All]]
    Each: ClassVar[type[Each]]
    Wavelengths: ClassVar[type[Wavelengths]]

_CLASSES["RasterBands"] = RasterBands
_VARIANTS["RasterBands"] = {}


class All(RasterBands, Variant):
    """One band for all bands of the scene, by its number from 1 or its name."""

    __slots__ = ()
    _ron = "All"

    value: float | str

    def __init__(self, value: float | str, /) -> None:
        super().__init__(value)

All._holds = _variant_holds("RasterBands", "All")
All._keys = {"value": {"schema": All._holds, "default": None}}

RasterBands.All = _VARIANTS["RasterBands"]["All"] = All


class Each(RasterBands, Variant):
    """A band for each band of the scene, by its number from 1 or its name."""

    __slots__ = ()
    _ron = "Each"

    value: dict[str, float | str]

    def __init__(self, value: Mapping[str, float | str], /) -> None:
        super().__init__(value)

Each._holds = _variant_holds("RasterBands", "Each")
Each._keys = {"value": {"schema": Each._holds, "default": None}}

RasterBands.Each = _VARIANTS["RasterBands"]["Each"] = Each


class Wavelengths(RasterBands, Variant):
    """All bands, by the wavelengths that the file gives them: joined by straight lines and averaged over each band of the scene."""

    __slots__ = ()
    _ron = "Wavelengths"

RasterBands.Wavelengths = _VARIANTS["RasterBands"]["Wavelengths"] = Wavelengths


class Prototype(Choice):
    """A mesh prototype."""

    __slots__ = ()

    Obj: ClassVar[type[Obj]]
    Gltf: ClassVar[type[Gltf]]
    Ply: ClassVar[type[Ply]]
    Discs: ClassVar[type[Discs]]
    Faces: ClassVar[type[Faces]]
    Crown: ClassVar[type[Crown]]

_CLASSES["Prototype"] = Prototype
_VARIANTS["Prototype"] = {}


class Obj(Prototype, Variant):
    """Wavefront OBJ; `parts_by` says what the parts are."""

    __slots__ = ()
    _ron = "Obj"

    file: str
    """Path, relative to the scene file."""
    up: Axis
    """Axis that points up."""
    unit_m: float | str
    """Length of the file's unit, m."""
    parts: dict[str, str]
    """Material of each part. `*` in a name stands for any text: `"leaf*": "leaf"`. An exact name counts before patterns, of these the one with most other letters, then the first."""
    parts_by: PartsBy
    """Statement of the file that names its parts."""
    material: str | None
    """Material of the parts that `parts` does not name."""
    origin: Origin
    """Point that becomes the origin."""

    def __init__(self, *, file: str | Unset = ..., up: Axis | Unset = ..., unit_m: float | str | Unset = ..., parts: Mapping[str, str] | Unset = ..., parts_by: PartsBy | Unset = ..., material: str | None | Unset = ..., origin: Origin | Unset = ...) -> None:
        super().__init__(file=file, up=up, unit_m=unit_m, parts=parts, parts_by=parts_by, material=material, origin=origin)

Obj._keys = {key['name']: key for key in _variant_keys("Prototype", "Obj")}

Prototype.Obj = _VARIANTS["Prototype"]["Obj"] = Obj


class Gltf(Prototype, Variant):
    """glTF 2.0 or GLB; materials are the parts."""

    __slots__ = ()
    _ron = "Gltf"

    file: str
    """Path, relative to the scene file."""
    up: Axis
    """Axis that points up (Y, if the file keeps to the standard)."""
    unit_m: float | str
    """Length of the file's unit, m."""
    parts: dict[str, str]
    """Material of each part. `*` in a name stands for any text: `"leaf*": "leaf"`. An exact name counts before patterns, of these the one with most other letters, then the first."""
    material: str | None
    """Material of the parts that `parts` does not name."""
    origin: Origin
    """Point that becomes the origin."""

    def __init__(self, *, file: str | Unset = ..., up: Axis | Unset = ..., unit_m: float | str | Unset = ..., parts: Mapping[str, str] | Unset = ..., material: str | None | Unset = ..., origin: Origin | Unset = ...) -> None:
        super().__init__(file=file, up=up, unit_m=unit_m, parts=parts, material=material, origin=origin)

Gltf._keys = {key['name']: key for key in _variant_keys("Prototype", "Gltf")}

Prototype.Gltf = _VARIANTS["Prototype"]["Gltf"] = Gltf


class Ply(Prototype, Variant):
    """PLY, ASCII or binary: one part."""

    __slots__ = ()
    _ron = "Ply"

    file: str
    """Path, relative to the scene file."""
    up: Axis
    """Axis that points up."""
    unit_m: float | str
    """Length of the file's unit, m."""
    material: str
    """Material of all of it."""
    origin: Origin
    """Point that becomes the origin."""

    def __init__(self, *, file: str | Unset = ..., up: Axis | Unset = ..., unit_m: float | str | Unset = ..., material: str | Unset = ..., origin: Origin | Unset = ...) -> None:
        super().__init__(file=file, up=up, unit_m=unit_m, material=material, origin=origin)

Ply._keys = {key['name']: key for key in _variant_keys("Prototype", "Ply")}

Prototype.Ply = _VARIANTS["Prototype"]["Ply"] = Ply


class Discs(Prototype, Variant):
    """A cloud of discs: CSV with the header `radius,x,y,z,nx,ny,nz`, or a RAMI `.def` text with rows `r x y z nx ny nz`; m, z up."""

    __slots__ = ()
    _ron = "Discs"

    file: str
    """Path, relative to the scene file."""
    material: str
    """Material of the discs."""

    def __init__(self, *, file: str | Unset = ..., material: str | Unset = ...) -> None:
        super().__init__(file=file, material=material)

Discs._keys = {key['name']: key for key in _variant_keys("Prototype", "Discs")}

Prototype.Discs = _VARIANTS["Prototype"]["Discs"] = Discs


class Faces(Prototype, Variant):
    """Polygons written here: sheets, walls, boxes."""

    __slots__ = ()
    _ron = "Faces"

    faces_m: list[list[tuple[float | str, float | str, float | str]]]
    """Corners of each polygon, m, counter-clockwise seen from its front."""
    material: str
    """Material of them all."""

    def __init__(self, *, faces_m: list[list[tuple[float | str, float | str, float | str]]] | Array | Unset = ..., material: str | Unset = ...) -> None:
        super().__init__(faces_m=faces_m, material=material)

Faces._keys = {key['name']: key for key in _variant_keys("Prototype", "Faces")}

Prototype.Faces = _VARIANTS["Prototype"]["Faces"] = Faces


class Crown(Prototype, Variant):
    """A tree or shrub generated leaf by leaf."""

    __slots__ = ()
    _ron = "Crown"

    shape: CrownShape
    """Outline of the crown."""
    base_m: float | str
    """Height of the crown's lowest point above the ground, m."""
    leaf_area_m2: float | str
    """One-sided area of all leaves, m²; 0 for none."""
    leaf_profile: LeafProfile
    """Vertical profile of leaf area."""
    clumps: Clumps | None
    """Clumps that leaves are gathered in; without them each stands by itself."""
    leaf_angle: LeafAngle
    """Distribution of leaf inclinations."""
    leaf: LeafShape
    """Shape and size of a leaf."""
    overlap: bool
    """False: no leaf intersects another leaf of the crown. Leaves keep their number and inclinations; those that would overlap stand elsewhere in the crown, or in their clump. The needles of one shoot may cross each other, and so may leaves of two instances."""
    min_distance_m: float | str
    """Minimum distance between the centres of two leaves of the crown, m; of shoots, between the middles of their twigs. Leaves that are nearer to an earlier one stand elsewhere, as with `overlap: false`. Leaves of a diameter up to this distance never intersect."""
    leaf_material: str
    """Material of the leaves."""
    trunk: Trunk | None
    """Trunk, if any."""
    branches: Branches | None
    """Branches from the trunk into the crown, if any."""
    wood_material: str | None
    """Material of trunk and branches."""
    seed: int | str
    """Another number is another tree of the same kind."""

    def __init__(self, *, shape: CrownShape | Unset = ..., base_m: float | str | Unset = ..., leaf_area_m2: float | str | Unset = ..., leaf_profile: LeafProfile | Unset = ..., clumps: Clumps | None | Unset = ..., leaf_angle: LeafAngle | Unset = ..., leaf: LeafShape | Unset = ..., overlap: bool | Unset = ..., min_distance_m: float | str | Unset = ..., leaf_material: str | Unset = ..., trunk: Trunk | None | Unset = ..., branches: Branches | None | Unset = ..., wood_material: str | None | Unset = ..., seed: int | str | Unset = ...) -> None:
        super().__init__(shape=shape, base_m=base_m, leaf_area_m2=leaf_area_m2, leaf_profile=leaf_profile, clumps=clumps, leaf_angle=leaf_angle, leaf=leaf, overlap=overlap, min_distance_m=min_distance_m, leaf_material=leaf_material, trunk=trunk, branches=branches, wood_material=wood_material, seed=seed)

Crown._keys = {key['name']: key for key in _variant_keys("Prototype", "Crown")}

Prototype.Crown = _VARIANTS["Prototype"]["Crown"] = Crown


class Axis(Choice):
    """The axis of a file's model that points to the zenith."""

    __slots__ = ()

    X: ClassVar[type[X]]
    Y: ClassVar[type[Y]]
    Z: ClassVar[type[Z]]

_CLASSES["Axis"] = Axis
_VARIANTS["Axis"] = {}


class X(Axis, Variant):
    """x points up, y to the east, z to the north."""

    __slots__ = ()
    _ron = "X"

Axis.X = _VARIANTS["Axis"]["X"] = X


class Y(Axis, Variant):
    """y points up; x stays east and -z points north."""

    __slots__ = ()
    _ron = "Y"

Axis.Y = _VARIANTS["Axis"]["Y"] = Y


class Z(Axis, Variant):
    """z points up: the frame of sunfleck."""

    __slots__ = ()
    _ron = "Z"

Axis.Z = _VARIANTS["Axis"]["Z"] = Z


class PartsBy(Choice):
    """Statement of an OBJ file that names its parts."""

    __slots__ = ()

    Group: ClassVar[type[Group]]
    Material: ClassVar[type[PartsByMaterial]]

_CLASSES["PartsBy"] = PartsBy
_VARIANTS["PartsBy"] = {}


class Group(PartsBy, Variant):
    """Groups (`g`, `o`), and within them materials: `crown`, or `crown/green` and `crown/brown` if the group has several materials."""

    __slots__ = ()
    _ron = "Group"

PartsBy.Group = _VARIANTS["PartsBy"]["Group"] = Group


class PartsByMaterial(PartsBy, Variant):
    """Materials (`usemtl`), whatever their groups."""

    __slots__ = ()
    _ron = "Material"

PartsBy.Material = _VARIANTS["PartsBy"]["Material"] = PartsByMaterial


class Origin(Choice):
    """Point of a file that becomes the origin of a prototype."""

    __slots__ = ()

    File: ClassVar[type[File]]
    BaseCenter: ClassVar[type[BaseCenter]]

_CLASSES["Origin"] = Origin
_VARIANTS["Origin"] = {}


class File(Origin, Variant):
    """The file's own origin."""

    __slots__ = ()
    _ron = "File"

Origin.File = _VARIANTS["Origin"]["File"] = File


class BaseCenter(Origin, Variant):
    """The middle of the bounding box, at its lowest height."""

    __slots__ = ()
    _ron = "BaseCenter"

Origin.BaseCenter = _VARIANTS["Origin"]["BaseCenter"] = BaseCenter


class CrownShape(Choice):
    """Outline of a generated crown."""

    __slots__ = ()

    Ellipsoid: ClassVar[type[Ellipsoid]]
    Cone: ClassVar[type[Cone]]
    Cylinder: ClassVar[type[Cylinder]]
    HalfEllipsoid: ClassVar[type[HalfEllipsoid]]
    AsymmetricGaussian: ClassVar[type[AsymmetricGaussian]]
    Box: ClassVar[type[CrownShapeBox]]

_CLASSES["CrownShape"] = CrownShape
_VARIANTS["CrownShape"] = {}


class Ellipsoid(CrownShape, Variant):
    """Ellipsoid of revolution."""

    __slots__ = ()
    _ron = "Ellipsoid"

    diameter_m: float | str
    """Largest width, m."""
    height_m: float | str
    """Height from its lowest to its highest point, m."""

    def __init__(self, *, diameter_m: float | str | Unset = ..., height_m: float | str | Unset = ...) -> None:
        super().__init__(diameter_m=diameter_m, height_m=height_m)

Ellipsoid._keys = {key['name']: key for key in _variant_keys("CrownShape", "Ellipsoid")}

CrownShape.Ellipsoid = _VARIANTS["CrownShape"]["Ellipsoid"] = Ellipsoid


class Cone(CrownShape, Variant):
    """Upright cone."""

    __slots__ = ()
    _ron = "Cone"

    diameter_m: float | str
    """Width at its base, m."""
    height_m: float | str
    """Height from base to tip, m."""

    def __init__(self, *, diameter_m: float | str | Unset = ..., height_m: float | str | Unset = ...) -> None:
        super().__init__(diameter_m=diameter_m, height_m=height_m)

Cone._keys = {key['name']: key for key in _variant_keys("CrownShape", "Cone")}

CrownShape.Cone = _VARIANTS["CrownShape"]["Cone"] = Cone


class Cylinder(CrownShape, Variant):
    """Upright cylinder."""

    __slots__ = ()
    _ron = "Cylinder"

    diameter_m: float | str
    """Width, m."""
    height_m: float | str
    """Height from base to top, m."""

    def __init__(self, *, diameter_m: float | str | Unset = ..., height_m: float | str | Unset = ...) -> None:
        super().__init__(diameter_m=diameter_m, height_m=height_m)

Cylinder._keys = {key['name']: key for key in _variant_keys("CrownShape", "Cylinder")}

CrownShape.Cylinder = _VARIANTS["CrownShape"]["Cylinder"] = Cylinder


class HalfEllipsoid(CrownShape, Variant):
    """Upper half of an ellipsoid of revolution: a dome on a flat base."""

    __slots__ = ()
    _ron = "HalfEllipsoid"

    diameter_m: float | str
    """Width at its base, m."""
    height_m: float | str
    """Height from base to top, m."""

    def __init__(self, *, diameter_m: float | str | Unset = ..., height_m: float | str | Unset = ...) -> None:
        super().__init__(diameter_m=diameter_m, height_m=height_m)

HalfEllipsoid._keys = {key['name']: key for key in _variant_keys("CrownShape", "HalfEllipsoid")}

CrownShape.HalfEllipsoid = _VARIANTS["CrownShape"]["HalfEllipsoid"] = HalfEllipsoid


class AsymmetricGaussian(CrownShape, Variant):
    """Solid of revolution of radius `(diameter / 2) exp(-((z - widest) / s)² / 2)` at z above its base, `s` being `below_m` under its widest place and `above_m` over it."""

    __slots__ = ()
    _ron = "AsymmetricGaussian"

    diameter_m: float | str
    """Largest width, m."""
    height_m: float | str
    """Height from base to top, which are flat, m."""
    widest_m: float | str
    """Height of the widest place above the base, m."""
    below_m: float | str
    """`s` below the widest place, m."""
    above_m: float | str
    """`s` above the widest place, m."""

    def __init__(self, *, diameter_m: float | str | Unset = ..., height_m: float | str | Unset = ..., widest_m: float | str | Unset = ..., below_m: float | str | Unset = ..., above_m: float | str | Unset = ...) -> None:
        super().__init__(diameter_m=diameter_m, height_m=height_m, widest_m=widest_m, below_m=below_m, above_m=above_m)

AsymmetricGaussian._keys = {key['name']: key for key in _variant_keys("CrownShape", "AsymmetricGaussian")}

CrownShape.AsymmetricGaussian = _VARIANTS["CrownShape"]["AsymmetricGaussian"] = AsymmetricGaussian


class CrownShapeBox(CrownShape, Variant):
    """Box, for homogeneous layers."""

    __slots__ = ()
    _ron = "Box"

    size_m: tuple[float | str, float | str, float | str]
    """Extent to the east, to the north and up, m."""

    def __init__(self, *, size_m: tuple[float | str, float | str, float | str] | Array | Unset = ...) -> None:
        super().__init__(size_m=size_m)

CrownShapeBox._keys = {key['name']: key for key in _variant_keys("CrownShape", "Box")}

CrownShape.Box = _VARIANTS["CrownShape"]["Box"] = CrownShapeBox


class LeafProfile(Choice):
    """Vertical profile of leaf area. Only ratios count: `leaf_area_m2` is the total."""

    __slots__ = ()

    Even: ClassVar[type[Even]]
    Density: ClassVar[type[Density]]
    Area: ClassVar[type[LeafProfileArea]]

_CLASSES["LeafProfile"] = LeafProfile
_VARIANTS["LeafProfile"] = {}


class Even(LeafProfile, Variant):
    """Constant leaf area density in the crown."""

    __slots__ = ()
    _ron = "Even"

LeafProfile.Even = _VARIANTS["LeafProfile"]["Even"] = Even


class Density(LeafProfile, Variant):
    """Leaf area density, m² m⁻³, by height above the ground, m: linear between, 0 beyond."""

    __slots__ = ()
    _ron = "Density"

    value: list[tuple[float | str, float | str]]

    def __init__(self, value: list[tuple[float | str, float | str]] | Array, /) -> None:
        super().__init__(value)

Density._holds = _variant_holds("LeafProfile", "Density")
Density._keys = {"value": {"schema": Density._holds, "default": None}}

LeafProfile.Density = _VARIANTS["LeafProfile"]["Density"] = Density


class LeafProfileArea(LeafProfile, Variant):
    """Leaf area in each metre of height, m² m⁻¹, by height above the ground, m: linear between, 0 beyond."""

    __slots__ = ()
    _ron = "Area"

    value: list[tuple[float | str, float | str]]

    def __init__(self, value: list[tuple[float | str, float | str]] | Array, /) -> None:
        super().__init__(value)

LeafProfileArea._holds = _variant_holds("LeafProfile", "Area")
LeafProfileArea._keys = {"value": {"schema": LeafProfileArea._holds, "default": None}}

LeafProfile.Area = _VARIANTS["LeafProfile"]["Area"] = LeafProfileArea


class Clumps(Record):
    """Leaves gathered in clumps: ellipsoids that hold the same number of leaves each. What would stand out of the crown is put elsewhere in its clump."""

    __slots__ = ()
    _ron = ""

    count: int | str
    """Number of them."""
    radius_m: float | str
    """Half of their width, m."""
    height_m: float | str | None
    """Height from their lowest to their highest point, m; their width if absent."""
    on_branches: bool
    """True if their middles are on branches; otherwise they are anywhere in the crown."""

    def __init__(self, *, count: int | str | Unset = ..., radius_m: float | str | Unset = ..., height_m: float | str | None | Unset = ..., on_branches: bool | Unset = ...) -> None:
        super().__init__(count=count, radius_m=radius_m, height_m=height_m, on_branches=on_branches)

Clumps._keys = {key['name']: key for key in _TYPES["Clumps"]["x-keys"]}

_CLASSES["Clumps"] = Clumps


class LeafAngle(Choice):
    """Distribution of the angle θ between leaf normal and zenith; azimuths are uniform.  Source: de Wit (1965), Photosynthesis of leaf canopies, Agricultural Research Reports 663, Wageningen, for the types; Bunnik (1978) for their trigonometric form."""

    __slots__ = ()

    Spherical: ClassVar[type[Spherical]]
    Uniform: ClassVar[type[LeafAngleUniform]]
    Planophile: ClassVar[type[Planophile]]
    Erectophile: ClassVar[type[Erectophile]]
    Plagiophile: ClassVar[type[Plagiophile]]
    Extremophile: ClassVar[type[Extremophile]]
    Ellipsoidal: ClassVar[type[Ellipsoidal]]
    Beta: ClassVar[type[Beta]]

_CLASSES["LeafAngle"] = LeafAngle
_VARIANTS["LeafAngle"] = {}


class Spherical(LeafAngle, Variant):
    """g(θ) = sin θ."""

    __slots__ = ()
    _ron = "Spherical"

LeafAngle.Spherical = _VARIANTS["LeafAngle"]["Spherical"] = Spherical


class LeafAngleUniform(LeafAngle, Variant):
    """g(θ) = 2/π."""

    __slots__ = ()
    _ron = "Uniform"

LeafAngle.Uniform = _VARIANTS["LeafAngle"]["Uniform"] = LeafAngleUniform


class Planophile(LeafAngle, Variant):
    """g(θ) = (2/π)(1 + cos 2θ): mostly horizontal leaves."""

    __slots__ = ()
    _ron = "Planophile"

LeafAngle.Planophile = _VARIANTS["LeafAngle"]["Planophile"] = Planophile


class Erectophile(LeafAngle, Variant):
    """g(θ) = (2/π)(1 - cos 2θ): mostly vertical leaves."""

    __slots__ = ()
    _ron = "Erectophile"

LeafAngle.Erectophile = _VARIANTS["LeafAngle"]["Erectophile"] = Erectophile


class Plagiophile(LeafAngle, Variant):
    """g(θ) = (2/π)(1 - cos 4θ): mostly leaves at 45°."""

    __slots__ = ()
    _ron = "Plagiophile"

LeafAngle.Plagiophile = _VARIANTS["LeafAngle"]["Plagiophile"] = Plagiophile


class Extremophile(LeafAngle, Variant):
    """g(θ) = (2/π)(1 + cos 4θ): mostly horizontal or vertical leaves."""

    __slots__ = ()
    _ron = "Extremophile"

LeafAngle.Extremophile = _VARIANTS["LeafAngle"]["Extremophile"] = Extremophile


class Ellipsoidal(LeafAngle, Variant):
    """Normals of an ellipsoid of revolution with a vertical axis; one of the two keys is written. Source: Campbell (1990), Agric. For. Meteorol. 49, 173–176."""

    __slots__ = ()
    _ron = "Ellipsoidal"

    x: float | str | None
    """Its horizontal over its vertical semi-axis: 1 is spherical, more is flatter."""
    mean_deg: float | str | None
    """Mean of θ, degrees."""

    def __init__(self, *, x: float | str | None | Unset = ..., mean_deg: float | str | None | Unset = ...) -> None:
        super().__init__(x=x, mean_deg=mean_deg)

Ellipsoidal._keys = {key['name']: key for key in _variant_keys("LeafAngle", "Ellipsoidal")}

LeafAngle.Ellipsoidal = _VARIANTS["LeafAngle"]["Ellipsoidal"] = Ellipsoidal


class Beta(LeafAngle, Variant):
    """g(θ) = (2/π)(1 - t)^(μ-1) t^(ν-1) / B(μ, ν) with t = 2θ/π; its mean is 90° ν/(μ + ν). Source: Goel & Strebel (1984), Agron. J. 76, 800–802."""

    __slots__ = ()
    _ron = "Beta"

    mu: float | str
    """Exponent μ, dimensionless."""
    nu: float | str
    """Exponent ν, dimensionless."""

    def __init__(self, *, mu: float | str | Unset = ..., nu: float | str | Unset = ...) -> None:
        super().__init__(mu=mu, nu=nu)

Beta._keys = {key['name']: key for key in _variant_keys("LeafAngle", "Beta")}

LeafAngle.Beta = _VARIANTS["LeafAngle"]["Beta"] = Beta


class LeafShape(Choice):
    """Shape of a generated leaf."""

    __slots__ = ()

    Disc: ClassVar[type[Disc]]
    Square: ClassVar[type[Square]]
    Rhombus: ClassVar[type[Rhombus]]
    Shoot: ClassVar[type[Shoot]]

_CLASSES["LeafShape"] = LeafShape
_VARIANTS["LeafShape"] = {}


class Disc(LeafShape, Variant):
    """Flat disc."""

    __slots__ = ()
    _ron = "Disc"

    radius_m: float | str
    """Radius, m."""

    def __init__(self, *, radius_m: float | str | Unset = ...) -> None:
        super().__init__(radius_m=radius_m)

Disc._keys = {key['name']: key for key in _variant_keys("LeafShape", "Disc")}

LeafShape.Disc = _VARIANTS["LeafShape"]["Disc"] = Disc


class Square(LeafShape, Variant):
    """Flat square."""

    __slots__ = ()
    _ron = "Square"

    side_m: float | str
    """Side, m."""

    def __init__(self, *, side_m: float | str | Unset = ...) -> None:
        super().__init__(side_m=side_m)

Square._keys = {key['name']: key for key in _variant_keys("LeafShape", "Square")}

LeafShape.Square = _VARIANTS["LeafShape"]["Square"] = Square


class Rhombus(LeafShape, Variant):
    """Flat rhombus."""

    __slots__ = ()
    _ron = "Rhombus"

    length_m: float | str
    """Long diagonal, m."""
    width_m: float | str
    """Short diagonal, m."""

    def __init__(self, *, length_m: float | str | Unset = ..., width_m: float | str | Unset = ...) -> None:
        super().__init__(length_m=length_m, width_m=width_m)

Rhombus._keys = {key['name']: key for key in _variant_keys("LeafShape", "Rhombus")}

LeafShape.Rhombus = _VARIANTS["LeafShape"]["Rhombus"] = Rhombus


class Shoot(LeafShape, Variant):
    """Needles in a spiral around a twig. The twig lies in the plane whose normal follows the leaf angle distribution, and has no wood itself."""

    __slots__ = ()
    _ron = "Shoot"

    length_m: float | str
    """Length of the twig, m."""
    needles: int | str
    """Number of needles."""
    needle_length_m: float | str
    """Length of a needle, m; it is a flat rectangle."""
    needle_width_m: float | str
    """Width of a needle, m."""
    needle_angle_deg: float | str
    """Angle between needle and twig, degrees."""

    def __init__(self, *, length_m: float | str | Unset = ..., needles: int | str | Unset = ..., needle_length_m: float | str | Unset = ..., needle_width_m: float | str | Unset = ..., needle_angle_deg: float | str | Unset = ...) -> None:
        super().__init__(length_m=length_m, needles=needles, needle_length_m=needle_length_m, needle_width_m=needle_width_m, needle_angle_deg=needle_angle_deg)

Shoot._keys = {key['name']: key for key in _variant_keys("LeafShape", "Shoot")}

LeafShape.Shoot = _VARIANTS["LeafShape"]["Shoot"] = Shoot


class Trunk(Record):
    """Trunk of a generated tree: a tapered, closed prism."""

    __slots__ = ()
    _ron = ""

    height_m: float | str
    """Height of its tip, m."""
    diameter_m: float | str
    """Diameter at the ground, m."""
    tip_diameter_m: float | str
    """Diameter at the tip, m."""

    def __init__(self, *, height_m: float | str | Unset = ..., diameter_m: float | str | Unset = ..., tip_diameter_m: float | str | Unset = ...) -> None:
        super().__init__(height_m=height_m, diameter_m=diameter_m, tip_diameter_m=tip_diameter_m)

Trunk._keys = {key['name']: key for key in _TYPES["Trunk"]["x-keys"]}

_CLASSES["Trunk"] = Trunk


class Branches(Record):
    """Branches of a generated tree, spread along the trunk within the crown."""

    __slots__ = ()
    _ron = ""

    count: int | str
    """Number of them."""
    diameter_m: float | str
    """Diameter at the trunk, m."""
    zenith_deg: float | str
    """Angle from the zenith, degrees."""

    def __init__(self, *, count: int | str | Unset = ..., diameter_m: float | str | Unset = ..., zenith_deg: float | str | Unset = ...) -> None:
        super().__init__(count=count, diameter_m=diameter_m, zenith_deg=zenith_deg)

Branches._keys = {key['name']: key for key in _TYPES["Branches"]["x-keys"]}

_CLASSES["Branches"] = Branches


class Terrain(Choice):
    """The ground."""

    __slots__ = ()

    Plane: ClassVar[type[Plane]]
    Raster: ClassVar[type[TerrainRaster]]
    Mesh: ClassVar[type[Mesh]]

_CLASSES["Terrain"] = Terrain
_VARIANTS["Terrain"] = {}


class Plane(Terrain, Variant):
    """Horizontal rectangle."""

    __slots__ = ()
    _ron = "Plane"

    size_m: tuple[float | str, float | str]
    """Extent to the east and to the north, m."""
    material: str
    """Material."""
    corner_m: tuple[float | str, float | str]
    """South-west corner, m."""
    height_m: float | str
    """Height, m."""

    def __init__(self, *, size_m: tuple[float | str, float | str] | Array | Unset = ..., material: str | Unset = ..., corner_m: tuple[float | str, float | str] | Array | Unset = ..., height_m: float | str | Unset = ...) -> None:
        super().__init__(size_m=size_m, material=material, corner_m=corner_m, height_m=height_m)

Plane._keys = {key['name']: key for key in _variant_keys("Terrain", "Plane")}

Terrain.Plane = _VARIANTS["Terrain"]["Plane"] = Plane


class TerrainRaster(Terrain, Variant):
    """Heights from a file: ESRI ASCII grid, ENVI or `GeoTIFF`. It lies where the file says, less the frame's origin."""

    __slots__ = ()
    _ron = "Raster"

    file: str
    """Path, relative to the scene file."""
    material: str | None
    """Material of all of it."""
    land_cover: LandCover | None
    """Materials by class, in place of `material`."""
    tolerance_m: float | str
    """Largest distance of the ground above or below a cell's height, m; 0 keeps every cell."""
    coordinates: Coordinates | None
    """Unit of the coordinates, where the file does not say; degrees are refused without it."""
    window: RasterWindow | None
    """Part of the raster that is read, to whole cells; all of it if left out."""
    height_unit_m: float | str | None
    """Length of the unit of the heights, m, in place of the file's: 0.01 for centimetres, 0.3048 for feet. Without it, heights that the file says are in feet become metres."""
    no_data: NoData
    """Treatment of cells without data."""
    corner_m: tuple[float | str, float | str] | None
    """South-west corner, m, in place of the file's."""
    size_m: tuple[float | str, float | str] | None
    """Extent to the east and to the north, m, in place of the file's."""
    lowest_m: float | str | None
    """Height of the lowest cell, m, in place of the file's."""

    def __init__(self, *, file: str | Unset = ..., material: str | None | Unset = ..., land_cover: LandCover | None | Unset = ..., tolerance_m: float | str | Unset = ..., coordinates: Coordinates | None | Unset = ..., window: RasterWindow | None | Unset = ..., height_unit_m: float | str | None | Unset = ..., no_data: NoData | Unset = ..., corner_m: tuple[float | str, float | str] | None | Array | Unset = ..., size_m: tuple[float | str, float | str] | None | Array | Unset = ..., lowest_m: float | str | None | Unset = ...) -> None:
        super().__init__(file=file, material=material, land_cover=land_cover, tolerance_m=tolerance_m, coordinates=coordinates, window=window, height_unit_m=height_unit_m, no_data=no_data, corner_m=corner_m, size_m=size_m, lowest_m=lowest_m)

TerrainRaster._keys = {key['name']: key for key in _variant_keys("Terrain", "Raster")}

Terrain.Raster = _VARIANTS["Terrain"]["Raster"] = TerrainRaster


class Mesh(Terrain, Variant):
    """A mesh, whose rectangle is the one around it."""

    __slots__ = ()
    _ron = "Mesh"

    mesh: str
    """Its name among `meshes`."""
    at_m: tuple[float | str, float | str, float | str]
    """Position of its origin, m."""

    def __init__(self, *, mesh: str | Unset = ..., at_m: tuple[float | str, float | str, float | str] | Array | Unset = ...) -> None:
        super().__init__(mesh=mesh, at_m=at_m)

Mesh._keys = {key['name']: key for key in _variant_keys("Terrain", "Mesh")}

Terrain.Mesh = _VARIANTS["Terrain"]["Mesh"] = Mesh


class LandCover(Record):
    """Classes of the ground from a raster."""

    __slots__ = ()
    _ron = ""

    file: str
    """Path, relative to the scene file."""
    classes: dict[str, str]
    """Material of each class, by its number or, of ENVI classifications, its name."""

    def __init__(self, *, file: str | Unset = ..., classes: Mapping[str, str] | Unset = ...) -> None:
        super().__init__(file=file, classes=classes)

LandCover._keys = {key['name']: key for key in _TYPES["LandCover"]["x-keys"]}

_CLASSES["LandCover"] = LandCover


class Coordinates(Choice):
    """Unit of the coordinates of a raster."""

    __slots__ = ()

    Metres: ClassVar[type[Metres]]
    Degrees: ClassVar[type[Degrees]]

_CLASSES["Coordinates"] = Coordinates
_VARIANTS["Coordinates"] = {}


class Metres(Coordinates, Variant):
    """Metres east and north."""

    __slots__ = ()
    _ron = "Metres"

Coordinates.Metres = _VARIANTS["Coordinates"]["Metres"] = Metres


class Degrees(Coordinates, Variant):
    """Longitude and latitude on WGS 84, taken for metres as they are in the raster's middle."""

    __slots__ = ()
    _ron = "Degrees"

Coordinates.Degrees = _VARIANTS["Coordinates"]["Degrees"] = Degrees


class RasterWindow(Record):
    """Part of a raster."""

    __slots__ = ()
    _ron = ""

    corner_m: tuple[float | str, float | str]
    """South-west corner, m, local frame: the map less `frame.origin_m`."""
    size_m: tuple[float | str, float | str]
    """Extent to the east and to the north, m."""

    def __init__(self, *, corner_m: tuple[float | str, float | str] | Array | Unset = ..., size_m: tuple[float | str, float | str] | Array | Unset = ...) -> None:
        super().__init__(corner_m=corner_m, size_m=size_m)

RasterWindow._keys = {key['name']: key for key in _TYPES["RasterWindow"]["x-keys"]}

_CLASSES["RasterWindow"] = RasterWindow


class NoData(Choice):
    """Treatment of cells without data."""

    __slots__ = ()

    Refuse: ClassVar[type[Refuse]]
    Neighbours: ClassVar[type[Neighbours]]
    Height: ClassVar[type[Height]]
    Hole: ClassVar[type[Hole]]

_CLASSES["NoData"] = NoData
_VARIANTS["NoData"] = {}


class Refuse(NoData, Variant):
    """They are an error."""

    __slots__ = ()
    _ron = "Refuse"

NoData.Refuse = _VARIANTS["NoData"]["Refuse"] = Refuse


class Neighbours(NoData, Variant):
    """They get the mean of the cells around them, ring by ring."""

    __slots__ = ()
    _ron = "Neighbours"

NoData.Neighbours = _VARIANTS["NoData"]["Neighbours"] = Neighbours


class Height(NoData, Variant):
    """They lie at this height, m, in the raster's heights."""

    __slots__ = ()
    _ron = "Height"

    value: float | str

    def __init__(self, value: float | str, /) -> None:
        super().__init__(value)

Height._holds = _variant_holds("NoData", "Height")
Height._keys = {"value": {"schema": Height._holds, "default": None}}

NoData.Height = _VARIANTS["NoData"]["Height"] = Height


class Hole(NoData, Variant):
    """They are holes: light that falls into them is lost."""

    __slots__ = ()
    _ron = "Hole"

NoData.Hole = _VARIANTS["NoData"]["Hole"] = Hole


class Instances(Choice):
    """Instances of mesh prototypes."""

    __slots__ = ()

    Table: ClassVar[type[InstancesTable]]
    List: ClassVar[type[InstancesList]]
    Scatter: ClassVar[type[Scatter]]
    CanopyHeights: ClassVar[type[CanopyHeights]]

_CLASSES["Instances"] = Instances
_VARIANTS["Instances"] = {}


class InstancesTable(Instances, Variant):
    """Places from a text table."""

    __slots__ = ()
    _ron = "Table"

    file: str
    """Path, relative to the scene file."""
    of: str | dict[str, str]
    """Mesh that stands there, or the mesh of each species: `{ "birch": "birch.tree" }`."""
    columns: list[str] | None
    """Names of the columns where the file has no header, or in place of those in its header: `x_m`, `y_m`, `z_m`, `yaw_deg` or `yaw_rad`, `tilt_deg`, `tilt_azimuth_deg`, `species` (a key of `of`), and for the size `scale` and `scale_vertical`, or `height_m` and `crown_diameter_m`. With `height_m` the top of the mesh is so high above its origin, with `crown_diameter_m` (or `diameter_m`) the mean of its extents to the east and to the north is so wide; where one of the two is missing, the mesh keeps its proportions. Columns of other names are let be."""
    on_terrain: bool
    """True if heights count from the terrain below each place. Without a column `z_m` they do in any case, and stems beside the ground stand at height 0."""
    coordinates: TableCoordinates | None
    """Origin of the coordinates; if absent, whichever of the two puts the stems on the terrain."""
    name: str | None
    """Name for `hide` and `select`."""

    def __init__(self, *, file: str | Unset = ..., of: str | Mapping[str, str] | Unset = ..., columns: list[str] | None | Array | Unset = ..., on_terrain: bool | Unset = ..., coordinates: TableCoordinates | None | Unset = ..., name: str | None | Unset = ...) -> None:
        super().__init__(file=file, of=of, columns=columns, on_terrain=on_terrain, coordinates=coordinates, name=name)

InstancesTable._keys = {key['name']: key for key in _variant_keys("Instances", "Table")}

Instances.Table = _VARIANTS["Instances"]["Table"] = InstancesTable


class InstancesList(Instances, Variant):
    """Places written here."""

    __slots__ = ()
    _ron = "List"

    of: str
    """Mesh that stands there."""
    at_m: list[tuple[float | str, float | str, float | str]]
    """Positions, m."""
    yaw_deg: list[float | str]
    """Turn of each (counter-clockwise seen from above), degrees; none if empty."""
    scale: list[float | str]
    """Scale of each; 1 if empty."""
    on_terrain: bool
    """True if heights count from the terrain below each place."""
    name: str | None
    """Name for `hide` and `select`."""

    def __init__(self, *, of: str | Unset = ..., at_m: list[tuple[float | str, float | str, float | str]] | Array | Unset = ..., yaw_deg: list[float | str] | Array | Unset = ..., scale: list[float | str] | Array | Unset = ..., on_terrain: bool | Unset = ..., name: str | None | Unset = ...) -> None:
        super().__init__(of=of, at_m=at_m, yaw_deg=yaw_deg, scale=scale, on_terrain=on_terrain, name=name)

InstancesList._keys = {key['name']: key for key in _variant_keys("Instances", "List")}

Instances.List = _VARIANTS["Instances"]["List"] = InstancesList


class Scatter(Instances, Variant):
    """Places by a rule, on the terrain. The same seed and name give the same places."""

    __slots__ = ()
    _ron = "Scatter"

    of: dict[str, float | str]
    """Meshes and their shares. One more leaves all stems in place: some become its own."""
    rule: Rule
    """Rule by which places are chosen."""
    stems: Stems
    """Number of stems."""
    inside: list[Area]
    """Only in these; everywhere if empty."""
    outside: list[Area]
    """Not in these."""
    yaw_deg: Distribution
    """Turn (counter-clockwise seen from above), degrees."""
    tilt_deg: Distribution
    """Lean from the vertical, degrees."""
    tilt_azimuth_deg: Distribution
    """Azimuth of the lean, degrees."""
    height_m: Distribution | None
    """Height, m, to which a mesh is scaled as a whole; as it is if absent."""
    scale: Distribution
    """Further scale."""
    scale_vertical: Distribution | None
    """Further vertical scale; that of `scale` if absent."""
    sink_m: float | str
    """Depth of the mesh's origin below the terrain, m."""
    name: str | None
    """Name for `hide` and `select`, and of the random numbers: with it, instances may come and go before these without moving them."""
    seed: int | str | None
    """Another number is another forest under the same light; that of `transport` if absent."""

    def __init__(self, *, of: Mapping[str, float | str] | Unset = ..., rule: Rule | Unset = ..., stems: Stems | Unset = ..., inside: list[Area] | Array | Unset = ..., outside: list[Area] | Array | Unset = ..., yaw_deg: Distribution | Unset = ..., tilt_deg: Distribution | Unset = ..., tilt_azimuth_deg: Distribution | Unset = ..., height_m: Distribution | None | Unset = ..., scale: Distribution | Unset = ..., scale_vertical: Distribution | None | Unset = ..., sink_m: float | str | Unset = ..., name: str | None | Unset = ..., seed: int | str | None | Unset = ...) -> None:
        super().__init__(of=of, rule=rule, stems=stems, inside=inside, outside=outside, yaw_deg=yaw_deg, tilt_deg=tilt_deg, tilt_azimuth_deg=tilt_azimuth_deg, height_m=height_m, scale=scale, scale_vertical=scale_vertical, sink_m=sink_m, name=name, seed=seed)

Scatter._keys = {key['name']: key for key in _variant_keys("Instances", "Scatter")}

Instances.Scatter = _VARIANTS["Instances"]["Scatter"] = Scatter


class CanopyHeights(Instances, Variant):
    """Trees as a canopy height model shows them, on the terrain."""

    __slots__ = ()
    _ron = "CanopyHeights"

    file: str
    """Raster of heights above the ground, m: ESRI ASCII grid, ENVI or `GeoTIFF`. It lies where the file says, as the terrain does; over the whole terrain if the file does not."""
    of: list[str]
    """Meshes. Each tree gets the one whose ratio of height to crown diameter is nearest to its own, scaled to both."""
    height_unit_m: float | str | None
    """Length of the unit of the heights, m, in place of the file's: 0.01 for centimetres, 0.3048 for feet. Without it, heights that the file says are in feet become metres."""
    min_height_m: float | str
    """Minimum height of a tree, m; anything lower is none."""
    window: tuple[float | str, float | str]
    """Two numbers a, b: of tops less than half of a m + b h² from one of height h m, only the highest counts."""
    sink_m: float | str
    """Depth of the mesh's origin below the terrain, m."""
    name: str | None
    """Name for `hide` and `select`, and of the random numbers that turn the trees."""

    def __init__(self, *, file: str | Unset = ..., of: list[str] | Array | Unset = ..., height_unit_m: float | str | None | Unset = ..., min_height_m: float | str | Unset = ..., window: tuple[float | str, float | str] | Array | Unset = ..., sink_m: float | str | Unset = ..., name: str | None | Unset = ...) -> None:
        super().__init__(file=file, of=of, height_unit_m=height_unit_m, min_height_m=min_height_m, window=window, sink_m=sink_m, name=name)

CanopyHeights._keys = {key['name']: key for key in _variant_keys("Instances", "CanopyHeights")}

Instances.CanopyHeights = _VARIANTS["Instances"]["CanopyHeights"] = CanopyHeights


class TableCoordinates(Choice):
    """Frame of the coordinates of a table."""

    __slots__ = ()

    Map: ClassVar[type[Map]]
    Local: ClassVar[type[Local]]

_CLASSES["TableCoordinates"] = TableCoordinates
_VARIANTS["TableCoordinates"] = {}


class Map(TableCoordinates, Variant):
    """Map coordinates, as those of rasters: `frame.origin_m` is subtracted, also from `z_m`, unless that counts from the terrain."""

    __slots__ = ()
    _ron = "Map"

TableCoordinates.Map = _VARIANTS["TableCoordinates"]["Map"] = Map


class Local(TableCoordinates, Variant):
    """Coordinates of the local frame."""

    __slots__ = ()
    _ron = "Local"

TableCoordinates.Local = _VARIANTS["TableCoordinates"]["Local"] = Local


class Rule(Choice):
    """Rule by which places are chosen."""

    __slots__ = ()

    Uniform: ClassVar[type[RuleUniform]]
    PoissonDisc: ClassVar[type[PoissonDisc]]
    Grid: ClassVar[type[RuleGrid]]

_CLASSES["Rule"] = Rule
_VARIANTS["Rule"] = {}


class RuleUniform(Rule, Variant):
    """Each place on its own, everywhere equally likely."""

    __slots__ = ()
    _ron = "Uniform"

Rule.Uniform = _VARIANTS["Rule"]["Uniform"] = RuleUniform


class PoissonDisc(Rule, Variant):
    """Uniform places, without those too close to an earlier one. In a periodic scene the distance counts across the borders."""

    __slots__ = ()
    _ron = "PoissonDisc"

    min_distance_m: float | str
    """Smallest distance between two stems, m."""

    def __init__(self, *, min_distance_m: float | str | Unset = ...) -> None:
        super().__init__(min_distance_m=min_distance_m)

PoissonDisc._keys = {key['name']: key for key in _variant_keys("Rule", "PoissonDisc")}

Rule.PoissonDisc = _VARIANTS["Rule"]["PoissonDisc"] = PoissonDisc


class RuleGrid(Rule, Variant):
    """Rows."""

    __slots__ = ()
    _ron = "Grid"

    spacing_m: tuple[float | str, float | str]
    """Distance of stems across and along the rows, m."""
    row_azimuth_deg: float | str
    """Azimuth of the rows, clockwise from north, degrees."""
    jitter_m: float | str
    """Largest displacement of a stem from its place, to the east and to the north, m."""

    def __init__(self, *, spacing_m: tuple[float | str, float | str] | Array | Unset = ..., row_azimuth_deg: float | str | Unset = ..., jitter_m: float | str | Unset = ...) -> None:
        super().__init__(spacing_m=spacing_m, row_azimuth_deg=row_azimuth_deg, jitter_m=jitter_m)

RuleGrid._keys = {key['name']: key for key in _variant_keys("Rule", "Grid")}

Rule.Grid = _VARIANTS["Rule"]["Grid"] = RuleGrid


class Stems(Choice):
    """Number of stems."""

    __slots__ = ()

    Count: ClassVar[type[Count]]
    PerHectare: ClassVar[type[PerHectare]]
    Raster: ClassVar[type[StemsRaster]]
    Fill: ClassVar[type[Fill]]

_CLASSES["Stems"] = Stems
_VARIANTS["Stems"] = {}


class Count(Stems, Variant):
    """A number of them."""

    __slots__ = ()
    _ron = "Count"

    value: int | str

    def __init__(self, value: int | str, /) -> None:
        super().__init__(value)

Count._holds = _variant_holds("Stems", "Count")
Count._keys = {"value": {"schema": Count._holds, "default": None}}

Stems.Count = _VARIANTS["Stems"]["Count"] = Count


class PerHectare(Stems, Variant):
    """Stems per hectare of the area where they may stand."""

    __slots__ = ()
    _ron = "PerHectare"

    value: float | str

    def __init__(self, value: float | str, /) -> None:
        super().__init__(value)

PerHectare._holds = _variant_holds("Stems", "PerHectare")
PerHectare._keys = {"value": {"schema": PerHectare._holds, "default": None}}

Stems.PerHectare = _VARIANTS["Stems"]["PerHectare"] = PerHectare


class StemsRaster(Stems, Variant):
    """Stems per hectare, place by place, from a raster: ESRI ASCII grid, ENVI or `GeoTIFF`. It lies where the file says, as the terrain does; over the whole terrain if the file does not. Beside it and where it has no data stands nothing."""

    __slots__ = ()
    _ron = "Raster"

    file: str
    """Path, relative to the scene file."""
    factor: float | str
    """Stems per hectare of a value of 1."""

    def __init__(self, *, file: str | Unset = ..., factor: float | str | Unset = ...) -> None:
        super().__init__(file=file, factor=factor)

StemsRaster._keys = {key['name']: key for key in _variant_keys("Stems", "Raster")}

Stems.Raster = _VARIANTS["Stems"]["Raster"] = StemsRaster


class Fill(Stems, Variant):
    """Maximum number of stems that the rule has room for."""

    __slots__ = ()
    _ron = "Fill"

Stems.Fill = _VARIANTS["Stems"]["Fill"] = Fill


class Area(Choice):
    """A part of the ground."""

    __slots__ = ()

    Polygon: ClassVar[type[Polygon]]
    GeoJson: ClassVar[type[GeoJson]]
    Table: ClassVar[type[AreaTable]]

_CLASSES["Area"] = Area
_VARIANTS["Area"] = {}


class Polygon(Area, Variant):
    """A polygon."""

    __slots__ = ()
    _ron = "Polygon"

    outline_m: list[tuple[float | str, float | str]]
    """Its corners in order, m; the last is joined to the first."""
    holes_m: list[list[tuple[float | str, float | str]]]
    """Corners of each hole, m."""

    def __init__(self, *, outline_m: list[tuple[float | str, float | str]] | Array | Unset = ..., holes_m: list[list[tuple[float | str, float | str]]] | Array | Unset = ...) -> None:
        super().__init__(outline_m=outline_m, holes_m=holes_m)

Polygon._keys = {key['name']: key for key in _variant_keys("Area", "Polygon")}

Area.Polygon = _VARIANTS["Area"]["Polygon"] = Polygon


class GeoJson(Area, Variant):
    """All polygons of a GeoJSON file in metres."""

    __slots__ = ()
    _ron = "GeoJson"

    file: str
    """Path, relative to the scene file."""
    georeferenced: bool
    """True if it holds eastings and northings: `frame.origin_m` is subtracted."""

    def __init__(self, *, file: str | Unset = ..., georeferenced: bool | Unset = ...) -> None:
        super().__init__(file=file, georeferenced=georeferenced)

GeoJson._keys = {key['name']: key for key in _variant_keys("Area", "GeoJson")}

Area.GeoJson = _VARIANTS["Area"]["GeoJson"] = GeoJson


class AreaTable(Area, Variant):
    """Polygons from a text table: columns `x_m`, `y_m`, and perhaps `ring` (another number is another ring) and `hole` (1 in rings that are holes of the outline before them)."""

    __slots__ = ()
    _ron = "Table"

    file: str
    """Path, relative to the scene file."""
    georeferenced: bool
    """True if it holds eastings and northings: `frame.origin_m` is subtracted."""

    def __init__(self, *, file: str | Unset = ..., georeferenced: bool | Unset = ...) -> None:
        super().__init__(file=file, georeferenced=georeferenced)

AreaTable._keys = {key['name']: key for key in _variant_keys("Area", "Table")}

Area.Table = _VARIANTS["Area"]["Table"] = AreaTable


class Distribution(Choice):
    """Distribution of a quantity over the stems."""

    __slots__ = ()

    Fixed: ClassVar[type[Fixed]]
    Uniform: ClassVar[type[DistributionUniform]]
    Normal: ClassVar[type[Normal]]
    LogNormal: ClassVar[type[LogNormal]]

_CLASSES["Distribution"] = Distribution
_VARIANTS["Distribution"] = {}


class Fixed(Distribution, Variant):
    """One value for all stems."""

    __slots__ = ()
    _ron = "Fixed"

    value: float | str

    def __init__(self, value: float | str, /) -> None:
        super().__init__(value)

Fixed._holds = _variant_holds("Distribution", "Fixed")
Fixed._keys = {"value": {"schema": Fixed._holds, "default": None}}

Distribution.Fixed = _VARIANTS["Distribution"]["Fixed"] = Fixed


class DistributionUniform(Distribution, Variant):
    """Equally likely from the first value to the second."""

    __slots__ = ()
    _ron = "Uniform"

    value: tuple[float | str, float | str]

    def __init__(self, value_1: float | str, value_2: float | str, /) -> None:
        super().__init__(value_1, value_2)

DistributionUniform._holds = _variant_holds("Distribution", "Uniform")
DistributionUniform._keys = {"value": {"schema": DistributionUniform._holds, "default": None}}

Distribution.Uniform = _VARIANTS["Distribution"]["Uniform"] = DistributionUniform


class Normal(Distribution, Variant):
    """Gaussian, cut off at `min` and `max`."""

    __slots__ = ()
    _ron = "Normal"

    mean: float | str
    """Mean of the Gaussian, in the unit of the key."""
    sd: float | str
    """Its standard deviation, in the same unit."""
    min: float | str | None
    """Smallest value, not above the mean."""
    max: float | str | None
    """Largest value, not below the mean."""

    def __init__(self, *, mean: float | str | Unset = ..., sd: float | str | Unset = ..., min: float | str | None | Unset = ..., max: float | str | None | Unset = ...) -> None:
        super().__init__(mean=mean, sd=sd, min=min, max=max)

Normal._keys = {key['name']: key for key in _variant_keys("Distribution", "Normal")}

Distribution.Normal = _VARIANTS["Distribution"]["Normal"] = Normal


class LogNormal(Distribution, Variant):
    """Its logarithm is Gaussian; cut off at `min` and `max`."""

    __slots__ = ()
    _ron = "LogNormal"

    median: float | str
    """Median, in the unit of the key."""
    sd_ln: float | str
    """Standard deviation of the natural logarithm, dimensionless."""
    min: float | str | None
    """Smallest value, not above the median."""
    max: float | str | None
    """Largest value, not below the median."""

    def __init__(self, *, median: float | str | Unset = ..., sd_ln: float | str | Unset = ..., min: float | str | None | Unset = ..., max: float | str | None | Unset = ...) -> None:
        super().__init__(median=median, sd_ln=sd_ln, min=min, max=max)

LogNormal._keys = {key['name']: key for key in _variant_keys("Distribution", "LogNormal")}

Distribution.LogNormal = _VARIANTS["Distribution"]["LogNormal"] = LogNormal


class Sun(Record):
    """The sun."""

    __slots__ = ()
    _ron = ""

    zenith_deg: float | str | None
    """Angle from the vertical, degrees, below 90."""
    azimuth_deg: float | str
    """Azimuth of the sun, clockwise from north, degrees."""
    position: SunPosition | None
    """Place and time that say where the sun is, in place of both angles. Below the horizon it gives no light: an error, or in a sweep a row without data, unless a sky of its own or emission is left."""
    disc_deg: float | str
    """Angular diameter of the disc, degrees, of even radiance; 0 is a parallel beam, and the real sun has 0.533."""
    irradiance: Spectrum
    """Irradiance on a plane perpendicular to the beam, W m⁻² nm⁻¹; with `sky: Fraction(..)` that of sun and sky together."""

    def __init__(self, *, zenith_deg: float | str | None | Unset = ..., azimuth_deg: float | str | Unset = ..., position: SunPosition | None | Unset = ..., disc_deg: float | str | Unset = ..., irradiance: Spectrum | Unset = ...) -> None:
        super().__init__(zenith_deg=zenith_deg, azimuth_deg=azimuth_deg, position=position, disc_deg=disc_deg, irradiance=irradiance)

Sun._keys = {key['name']: key for key in _TYPES["Sun"]["x-keys"]}

_CLASSES["Sun"] = Sun


class SunPosition(Choice):
    """Source of the sun's position."""

    __slots__ = ()

    Spa: ClassVar[type[Spa]]

_CLASSES["SunPosition"] = SunPosition
_VARIANTS["SunPosition"] = {}


class Spa(SunPosition, Variant):
    """Position from place and time by the Solar Position Algorithm, accurate to 0.0003°.  Source: Reda and Andreas (2004), Solar Energy 76, 577-589."""

    __slots__ = ()
    _ron = "Spa"

    date: tuple[int | str, int | str, int | str]
    """Year, month and day."""
    time: tuple[float | str, float | str, float | str]
    """Hour, minute and second, each with a fraction if need be: `(12.5, 0, 0)`."""
    utc_offset_h: float | str
    """Hours that the clock is ahead of UTC: 1 in Berlin in winter, -7 in Denver."""
    latitude_deg: float | str
    """North is positive, degrees."""
    longitude_deg: float | str
    """East is positive, degrees."""
    altitude_m: float | str
    """Above sea level, m."""
    pressure_hpa: float | str
    """Air pressure of the refraction, hPa; 0 leaves refraction out."""
    temperature_c: float | str
    """Air temperature of the refraction, °C."""
    delta_t_s: float | str | None
    """Terrestrial time less universal time, s; estimated from the date if absent."""

    def __init__(self, *, date: tuple[int | str, int | str, int | str] | Array | Unset = ..., time: tuple[float | str, float | str, float | str] | Array | Unset = ..., utc_offset_h: float | str | Unset = ..., latitude_deg: float | str | Unset = ..., longitude_deg: float | str | Unset = ..., altitude_m: float | str | Unset = ..., pressure_hpa: float | str | Unset = ..., temperature_c: float | str | Unset = ..., delta_t_s: float | str | None | Unset = ...) -> None:
        super().__init__(date=date, time=time, utc_offset_h=utc_offset_h, latitude_deg=latitude_deg, longitude_deg=longitude_deg, altitude_m=altitude_m, pressure_hpa=pressure_hpa, temperature_c=temperature_c, delta_t_s=delta_t_s)

Spa._keys = {key['name']: key for key in _variant_keys("SunPosition", "Spa")}

SunPosition.Spa = _VARIANTS["SunPosition"]["Spa"] = Spa


class Sky(Choice):
    """The sky."""

    __slots__ = ()

    None_: ClassVar[type[SkyNone]]
    Fraction: ClassVar[type[SkyFraction]]
    Isotropic: ClassVar[type[Isotropic]]

_CLASSES["Sky"] = Sky
_VARIANTS["Sky"] = {}


class SkyNone(Sky, Variant):
    """Black."""

    __slots__ = ()
    _ron = "None"

Sky.None_ = _VARIANTS["Sky"]["None"] = SkyNone


class SkyFraction(Sky, Variant):
    """Isotropic; the share of the total irradiance that is diffuse, band by band (`SKY_TO_TOTAL`): the sun keeps `irradiance (1 - s)`, the sky gives the horizontal plane `irradiance s cos(sun zenith)`."""

    __slots__ = ()
    _ron = "Fraction"

    value: list[float | str]

    def __init__(self, value: list[float | str] | Array, /) -> None:
        super().__init__(value)

SkyFraction._holds = _variant_holds("Sky", "Fraction")
SkyFraction._keys = {"value": {"schema": SkyFraction._holds, "default": None}}

Sky.Fraction = _VARIANTS["Sky"]["Fraction"] = SkyFraction


class Isotropic(Sky, Variant):
    """Isotropic, of its own irradiance."""

    __slots__ = ()
    _ron = "Isotropic"

    irradiance: Spectrum
    """Irradiance on the horizontal plane, W m⁻² nm⁻¹."""

    def __init__(self, *, irradiance: Spectrum | Unset = ...) -> None:
        super().__init__(irradiance=irradiance)

Isotropic._keys = {key['name']: key for key in _variant_keys("Sky", "Isotropic")}

Sky.Isotropic = _VARIANTS["Sky"]["Isotropic"] = Isotropic


class ThermalSky(Choice):
    """Emission of the sky."""

    __slots__ = ()

    None_: ClassVar[type[ThermalSkyNone]]
    BlackBody: ClassVar[type[BlackBody]]
    Radiance: ClassVar[type[ThermalSkyRadiance]]

_CLASSES["ThermalSky"] = ThermalSky
_VARIANTS["ThermalSky"] = {}


class ThermalSkyNone(ThermalSky, Variant):
    """Nothing."""

    __slots__ = ()
    _ron = "None"

ThermalSky.None_ = _VARIANTS["ThermalSky"]["None"] = ThermalSkyNone


class BlackBody(ThermalSky, Variant):
    """Isotropic, like a black body of this temperature, K."""

    __slots__ = ()
    _ron = "BlackBody"

    value: float | str

    def __init__(self, value: float | str, /) -> None:
        super().__init__(value)

BlackBody._holds = _variant_holds("ThermalSky", "BlackBody")
BlackBody._keys = {"value": {"schema": BlackBody._holds, "default": None}}

ThermalSky.BlackBody = _VARIANTS["ThermalSky"]["BlackBody"] = BlackBody


class ThermalSkyRadiance(ThermalSky, Variant):
    """Isotropic, of this radiance, W m⁻² sr⁻¹ nm⁻¹; π times that falls on the horizontal plane."""

    __slots__ = ()
    _ron = "Radiance"

    value: Spectrum

    def __init__(self, value: Spectrum, /) -> None:
        super().__init__(value)

ThermalSkyRadiance._holds = _variant_holds("ThermalSky", "Radiance")
ThermalSkyRadiance._keys = {"value": {"schema": ThermalSkyRadiance._holds, "default": None}}

ThermalSky.Radiance = _VARIANTS["ThermalSky"]["Radiance"] = ThermalSkyRadiance


class Boundary(Choice):
    """Surroundings of the terrain's rectangle."""

    __slots__ = ()

    Periodic: ClassVar[type[Periodic]]
    Isolated: ClassVar[type[Isolated]]

_CLASSES["Boundary"] = Boundary
_VARIANTS["Boundary"] = {}


class Periodic(Boundary, Variant):
    """Endless copies of the scene."""

    __slots__ = ()
    _ron = "Periodic"

Boundary.Periodic = _VARIANTS["Boundary"]["Periodic"] = Periodic


class Isolated(Boundary, Variant):
    """Nothing."""

    __slots__ = ()
    _ron = "Isolated"

Boundary.Isolated = _VARIANTS["Boundary"]["Isolated"] = Isolated


class Sensor(Choice):
    """A sensor."""

    __slots__ = ()

    Orthographic: ClassVar[type[SensorOrthographic]]
    Perspective: ClassVar[type[Perspective]]
    Fisheye: ClassVar[type[Fisheye]]
    Directions: ClassVar[type[Directions]]
    Photons: ClassVar[type[Photons]]

_CLASSES["Sensor"] = Sensor
_VARIANTS["Sensor"] = {}


class SensorOrthographic(Sensor, Variant):
    """Parallel-projection image."""

    __slots__ = ()
    _ron = "Orthographic"

    size_px: tuple[int | str, int | str] | None
    """Columns and rows; either this or `pixel_m` is required."""
    pixel_m: float | str | None
    """Side of a square pixel in the plane perpendicular to the view, m, in place of `size_px`. A footprint that is no whole number of pixels grows around its middle to the next one."""
    extent_m: tuple[float | str, float | str] | None
    """Width and height of the footprint in the plane perpendicular to the view, m."""
    cover: Cover | None
    """`WholeScene`, in place of `extent_m` and `center_m`."""
    center_m: tuple[float | str, float | str] | None
    """Point on the ground in the middle of the image, m; the terrain's middle if absent."""
    zenith_deg: float | str
    """Zenith angle of the sensor, degrees."""
    azimuth_deg: float | str
    """Azimuth of the sensor, clockwise from north, degrees. A nadir image has north up at 180."""
    samples_per_px: int | str | None
    """Samples per pixel; 64 if neither this nor `samples_per_m2` is written."""
    samples_per_m2: float | str | None
    """Samples per m² of the footprint, in place of `samples_per_px`."""
    virtual_plane: VirtualPlane | None
    """Only light that leaves through it is seen."""
    until: StopCriterion | list[StopCriterion] | None
    """Criteria that end the measurement; the number of samples then is no limit."""
    measure: list[ImageMeasure]
    """Quantities to report."""
    denoised: bool
    """True if each image of light has a denoised one beside it, such as `brf_denoised`: `D = y + Σ a (G y - y)` with Gaussian filters `G` of four widths, whose weights `a` minimise Stein's (1981) unbiased estimate of the squared error around each pixel. Its standard errors include the bias of the filter."""
    picture: Picture
    """Colours of its PNG."""
    system: System
    """Transport system that estimates it."""

    def __init__(self, *, size_px: tuple[int | str, int | str] | None | Array | Unset = ..., pixel_m: float | str | None | Unset = ..., extent_m: tuple[float | str, float | str] | None | Array | Unset = ..., cover: Cover | None | Unset = ..., center_m: tuple[float | str, float | str] | None | Array | Unset = ..., zenith_deg: float | str | Unset = ..., azimuth_deg: float | str | Unset = ..., samples_per_px: int | str | None | Unset = ..., samples_per_m2: float | str | None | Unset = ..., virtual_plane: VirtualPlane | None | Unset = ..., until: StopCriterion | list[StopCriterion] | None | Array | Unset = ..., measure: list[ImageMeasure] | Array | Unset = ..., denoised: bool | Unset = ..., picture: Picture | Unset = ..., system: System | Unset = ...) -> None:
        super().__init__(size_px=size_px, pixel_m=pixel_m, extent_m=extent_m, cover=cover, center_m=center_m, zenith_deg=zenith_deg, azimuth_deg=azimuth_deg, samples_per_px=samples_per_px, samples_per_m2=samples_per_m2, virtual_plane=virtual_plane, until=until, measure=measure, denoised=denoised, picture=picture, system=system)

SensorOrthographic._keys = {key['name']: key for key in _variant_keys("Sensor", "Orthographic")}

Sensor.Orthographic = _VARIANTS["Sensor"]["Orthographic"] = SensorOrthographic


class Perspective(Sensor, Variant):
    """Image of a camera in the scene or beside it, straight lines stay straight."""

    __slots__ = ()
    _ron = "Perspective"

    size_px: tuple[int | str, int | str]
    """Columns and rows."""
    position_m: tuple[float | str, float | str, float | str]
    """Position of the camera, m."""
    target_m: tuple[float | str, float | str, float | str]
    """Point in the middle of the image, m."""
    up: tuple[float | str, float | str, float | str]
    """Direction that is up in the image; it need not be perpendicular to the view."""
    fov_deg: tuple[float | str, float | str]
    """Full angles of view across and down the image, degrees, each its own."""
    above_ground: bool
    """True if heights of position and target count from the ground below each."""
    sees_sky: bool
    """True if pixels without a hit show the sky; otherwise they hold no data."""
    samples_per_px: int | str
    """Samples per pixel."""
    until: StopCriterion | list[StopCriterion] | None
    """Criteria that end the measurement; the number of samples then is no limit."""
    measure: list[ImageMeasure]
    """Quantities to report."""
    denoised: bool
    """True if each image of light has a denoised one beside it, such as `brf_denoised`: `D = y + Σ a (G y - y)` with Gaussian filters `G` of four widths, whose weights `a` minimise Stein's (1981) unbiased estimate of the squared error around each pixel. Its standard errors include the bias of the filter."""
    picture: Picture
    """Colours of its PNG."""
    system: System
    """Transport system that estimates it."""

    def __init__(self, *, size_px: tuple[int | str, int | str] | Array | Unset = ..., position_m: tuple[float | str, float | str, float | str] | Array | Unset = ..., target_m: tuple[float | str, float | str, float | str] | Array | Unset = ..., up: tuple[float | str, float | str, float | str] | Array | Unset = ..., fov_deg: tuple[float | str, float | str] | Array | Unset = ..., above_ground: bool | Unset = ..., sees_sky: bool | Unset = ..., samples_per_px: int | str | Unset = ..., until: StopCriterion | list[StopCriterion] | None | Array | Unset = ..., measure: list[ImageMeasure] | Array | Unset = ..., denoised: bool | Unset = ..., picture: Picture | Unset = ..., system: System | Unset = ...) -> None:
        super().__init__(size_px=size_px, position_m=position_m, target_m=target_m, up=up, fov_deg=fov_deg, above_ground=above_ground, sees_sky=sees_sky, samples_per_px=samples_per_px, until=until, measure=measure, denoised=denoised, picture=picture, system=system)

Perspective._keys = {key['name']: key for key in _variant_keys("Sensor", "Perspective")}

Sensor.Perspective = _VARIANTS["Sensor"]["Perspective"] = Perspective


class Fisheye(Sensor, Variant):
    """Image of a camera that sees a hemisphere or more of its surroundings, as a disc as wide as the image's shorter side; no data beside it. Of the sun it sees what it lights, not the disc."""

    __slots__ = ()
    _ron = "Fisheye"

    size_px: tuple[int | str, int | str]
    """Columns and rows."""
    position_m: tuple[float | str, float | str, float | str]
    """Position of the camera, m."""
    look: Look
    """Direction or point in the middle of the image."""
    up: tuple[float | str, float | str] | None
    """Direction that is up in the image; north if it looks `Up` or `Down`, the vertical if not."""
    fov_deg: float | str
    """Full angle of view, degrees: the disc's edge shows half of it off the axis."""
    projection: FisheyeProjection
    """Mapping of angles off the axis to distances from the middle."""
    above_ground: bool
    """True if heights of position and target count from the ground below each."""
    sees_sky: bool
    """True if pixels without a hit show the sky; otherwise they hold no data."""
    samples_per_px: int | str
    """Samples per pixel."""
    until: StopCriterion | list[StopCriterion] | None
    """Criteria that end the measurement; the number of samples then is no limit."""
    measure: list[ImageMeasure]
    """Quantities to report."""
    denoised: bool
    """True if each image of light has a denoised one beside it, such as `brf_denoised`: `D = y + Σ a (G y - y)` with Gaussian filters `G` of four widths, whose weights `a` minimise Stein's (1981) unbiased estimate of the squared error around each pixel. Its standard errors include the bias of the filter."""
    picture: Picture
    """Colours of its PNG."""
    system: System
    """Transport system that estimates it."""

    def __init__(self, *, size_px: tuple[int | str, int | str] | Array | Unset = ..., position_m: tuple[float | str, float | str, float | str] | Array | Unset = ..., look: Look | Unset = ..., up: tuple[float | str, float | str] | None | Array | Unset = ..., fov_deg: float | str | Unset = ..., projection: FisheyeProjection | Unset = ..., above_ground: bool | Unset = ..., sees_sky: bool | Unset = ..., samples_per_px: int | str | Unset = ..., until: StopCriterion | list[StopCriterion] | None | Array | Unset = ..., measure: list[ImageMeasure] | Array | Unset = ..., denoised: bool | Unset = ..., picture: Picture | Unset = ..., system: System | Unset = ...) -> None:
        super().__init__(size_px=size_px, position_m=position_m, look=look, up=up, fov_deg=fov_deg, projection=projection, above_ground=above_ground, sees_sky=sees_sky, samples_per_px=samples_per_px, until=until, measure=measure, denoised=denoised, picture=picture, system=system)

Fisheye._keys = {key['name']: key for key in _variant_keys("Sensor", "Fisheye")}

Sensor.Fisheye = _VARIANTS["Sensor"]["Fisheye"] = Fisheye


class Directions(Sensor, Variant):
    """The scene seen from many directions: the mean over all lines through the rectangle of its ground. `scenes/ISOLATED.md` says what that is where the scene ends."""

    __slots__ = ()
    _ron = "Directions"

    views: Views
    """Directions towards the sensors."""
    until: StopCriterion | list[StopCriterion]
    """Criteria that end the measurement."""
    measure: list[ImageMeasure]
    """Quantities to report."""
    virtual_plane: VirtualPlane | None
    """Only light that leaves through it counts; it is what is seen."""
    system: System | None
    """Transport system that estimates it; if absent the one that takes fewer rays: photon packets for what a whole scene reflects in several directions, paths from the sensor for the rest."""

    def __init__(self, *, views: Views | Unset = ..., until: StopCriterion | list[StopCriterion] | Array | Unset = ..., measure: list[ImageMeasure] | Array | Unset = ..., virtual_plane: VirtualPlane | None | Unset = ..., system: System | None | Unset = ...) -> None:
        super().__init__(views=views, until=until, measure=measure, virtual_plane=virtual_plane, system=system)

Directions._keys = {key['name']: key for key in _variant_keys("Sensor", "Directions")}

Sensor.Directions = _VARIANTS["Sensor"]["Directions"] = Directions


class Photons(Sensor, Variant):
    """Photon packets from sun and sky, and from what surfaces and `thermal_sky` emit."""

    __slots__ = ()
    _ron = "Photons"

    per_m2: float | str
    """Packets per m² of the terrain's rectangle; of emitted light, lines through the scene along each of which several start."""
    until: StopCriterion | list[StopCriterion] | None
    """Criteria that end the measurement; `per_m2` then is no limit."""
    measure: list[PhotonMeasure]
    """Quantities to report."""
    virtual_plane: VirtualPlane | None
    """Only light that leaves through it counts as reflected, and only what lies below it absorbs; all is normalised to its area."""
    system: System
    """Transport system: packets (`Forward`) or photons (`Analog`)."""

    def __init__(self, *, per_m2: float | str | Unset = ..., until: StopCriterion | list[StopCriterion] | None | Array | Unset = ..., measure: list[PhotonMeasure] | Array | Unset = ..., virtual_plane: VirtualPlane | None | Unset = ..., system: System | Unset = ...) -> None:
        super().__init__(per_m2=per_m2, until=until, measure=measure, virtual_plane=virtual_plane, system=system)

Photons._keys = {key['name']: key for key in _variant_keys("Sensor", "Photons")}

Sensor.Photons = _VARIANTS["Sensor"]["Photons"] = Photons


class Cover(Choice):
    """Area that an orthographic image covers, in place of a rectangle."""

    __slots__ = ()

    WholeScene: ClassVar[type[WholeScene]]

_CLASSES["Cover"] = Cover
_VARIANTS["Cover"] = {}


class WholeScene(Cover, Variant):
    """Everything that stands on the terrain's rectangle, from whichever side."""

    __slots__ = ()
    _ron = "WholeScene"

Cover.WholeScene = _VARIANTS["Cover"]["WholeScene"] = WholeScene


class VirtualPlane(Record):
    """A horizontal rectangle through which light leaves the scene."""

    __slots__ = ()
    _ron = ""

    center_m: tuple[float | str, float | str] | None
    """Its middle, m; that of the terrain if absent."""
    size_m: tuple[float | str, float | str] | None
    """Extent to the east and to the north, m; that of the terrain if absent."""
    height_m: float | str | None
    """Height, m; that of the highest point of the scene if absent."""

    def __init__(self, *, center_m: tuple[float | str, float | str] | None | Array | Unset = ..., size_m: tuple[float | str, float | str] | None | Array | Unset = ..., height_m: float | str | None | Unset = ...) -> None:
        super().__init__(center_m=center_m, size_m=size_m, height_m=height_m)

VirtualPlane._keys = {key['name']: key for key in _TYPES["VirtualPlane"]["x-keys"]}

_CLASSES["VirtualPlane"] = VirtualPlane


class StopCriterion(Choice):
    """Criteria that end a measurement."""

    __slots__ = ()

    RelError: ClassVar[type[RelError]]
    RelErrors: ClassVar[type[RelErrors]]
    Seconds: ClassVar[type[Seconds]]
    Samples: ClassVar[type[Samples]]

_CLASSES["StopCriterion"] = StopCriterion
_VARIANTS["StopCriterion"] = {}


class RelError(StopCriterion, Variant):
    """The median relative standard error of each product that the sensor reports is at most this; of an image it is that of its pixels."""

    __slots__ = ()
    _ron = "RelError"

    value: float | str

    def __init__(self, value: float | str, /) -> None:
        super().__init__(value)

RelError._holds = _variant_holds("StopCriterion", "RelError")
RelError._keys = {"value": {"schema": RelError._holds, "default": None}}

StopCriterion.RelError = _VARIANTS["StopCriterion"]["RelError"] = RelError


class RelErrors(StopCriterion, Variant):
    """The median relative standard error of each of these products is at most this: names as in `summary.json`."""

    __slots__ = ()
    _ron = "RelErrors"

    value: dict[str, float | str]

    def __init__(self, value: Mapping[str, float | str], /) -> None:
        super().__init__(value)

RelErrors._holds = _variant_holds("StopCriterion", "RelErrors")
RelErrors._keys = {"value": {"schema": RelErrors._holds, "default": None}}

StopCriterion.RelErrors = _VARIANTS["StopCriterion"]["RelErrors"] = RelErrors


class Seconds(StopCriterion, Variant):
    """It has run for this number of seconds."""

    __slots__ = ()
    _ron = "Seconds"

    value: float | str

    def __init__(self, value: float | str, /) -> None:
        super().__init__(value)

Seconds._holds = _variant_holds("StopCriterion", "Seconds")
Seconds._keys = {"value": {"schema": Seconds._holds, "default": None}}

StopCriterion.Seconds = _VARIANTS["StopCriterion"]["Seconds"] = Seconds


class Samples(StopCriterion, Variant):
    """Samples per pixel or direction; of `Photons`, the number of packets."""

    __slots__ = ()
    _ron = "Samples"

    value: int | str

    def __init__(self, value: int | str, /) -> None:
        super().__init__(value)

Samples._holds = _variant_holds("StopCriterion", "Samples")
Samples._keys = {"value": {"schema": Samples._holds, "default": None}}

StopCriterion.Samples = _VARIANTS["StopCriterion"]["Samples"] = Samples


class ImageMeasure(Choice):
    """Quantity of an image or of a list of directions."""

    __slots__ = ()

    Radiance: ClassVar[type[ImageMeasureRadiance]]
    Brf: ClassVar[type[Brf]]
    Orders: ClassVar[type[ImageMeasureOrders]]
    BrightnessTemperature: ClassVar[type[ImageMeasureBrightnessTemperature]]
    FourComponents: ClassVar[type[FourComponents]]
    GapFraction: ClassVar[type[GapFraction]]

_CLASSES["ImageMeasure"] = ImageMeasure
_VARIANTS["ImageMeasure"] = {}


class ImageMeasureRadiance(ImageMeasure, Variant):
    """Radiance, W m⁻² sr⁻¹ nm⁻¹, from the sources that the band names."""

    __slots__ = ()
    _ron = "Radiance"

ImageMeasure.Radiance = _VARIANTS["ImageMeasure"]["Radiance"] = ImageMeasureRadiance


class Brf(ImageMeasure, Variant):
    """Bidirectional reflectance factor; under a sky it is the HDRF and is named so."""

    __slots__ = ()
    _ron = "Brf"

ImageMeasure.Brf = _VARIANTS["ImageMeasure"]["Brf"] = Brf


class ImageMeasureOrders(ImageMeasure, Variant):
    """The BRF, split as RAMI does: `brf_uc` (scattered once, by the ground), `brf_co_sgl` (once, by anything else) and `brf_mlt` (more often)."""

    __slots__ = ()
    _ron = "Orders"

ImageMeasure.Orders = _VARIANTS["ImageMeasure"]["Orders"] = ImageMeasureOrders


class ImageMeasureBrightnessTemperature(ImageMeasure, Variant):
    """Temperature of the black body of this radiance, K, in bands that hold emission."""

    __slots__ = ()
    _ron = "BrightnessTemperature"

ImageMeasure.BrightnessTemperature = _VARIANTS["ImageMeasure"]["BrightnessTemperature"] = ImageMeasureBrightnessTemperature


class FourComponents(ImageMeasure, Variant):
    """Shares of sunlit ground, sunlit canopy, shaded ground and shaded canopy in what is seen; of an image the dominant one too. Sunlit is where the sun is visible from the side that is seen, so a leaf that is lit from above is shaded from below; temperatures of `SunlitShaded` count both sides of it as sunlit. Ground is the terrain."""

    __slots__ = ()
    _ron = "FourComponents"

ImageMeasure.FourComponents = _VARIANTS["ImageMeasure"]["FourComponents"] = FourComponents


class GapFraction(ImageMeasure, Variant):
    """Share of the ground in what is seen, or of the sky in a camera that looks up; of directions, and of a fisheye that looks straight up or down, the leaf area index that it implies too."""

    __slots__ = ()
    _ron = "GapFraction"

ImageMeasure.GapFraction = _VARIANTS["ImageMeasure"]["GapFraction"] = GapFraction


class Picture(Choice):
    """Colours of the PNG of an image. The numbers are in the other files."""

    __slots__ = ()

    Quicklook: ClassVar[type[Quicklook]]
    Bands: ClassVar[type[PictureBands]]
    Cie: ClassVar[type[Cie]]

_CLASSES["Picture"] = Picture
_VARIANTS["Picture"] = {}


class Quicklook(Picture, Variant):
    """Quick look: bands chosen by wavelength, each stretched."""

    __slots__ = ()
    _ron = "Quicklook"

Picture.Quicklook = _VARIANTS["Picture"]["Quicklook"] = Quicklook


class PictureBands(Picture, Variant):
    """Three bands."""

    __slots__ = ()
    _ron = "Bands"

    red: str
    """Band that is shown as red."""
    green: str
    """Band that is shown as green."""
    blue: str
    """Band that is shown as blue."""
    exposure_stops: float | str | None
    """Stops over the exposure that shows a white surface on the horizontal as white; automatic if absent."""

    def __init__(self, *, red: str | Unset = ..., green: str | Unset = ..., blue: str | Unset = ..., exposure_stops: float | str | None | Unset = ...) -> None:
        super().__init__(red=red, green=green, blue=blue, exposure_stops=exposure_stops)

PictureBands._keys = {key['name']: key for key in _variant_keys("Picture", "Bands")}

Picture.Bands = _VARIANTS["Picture"]["Bands"] = PictureBands


class Cie(Picture, Variant):
    """Colours as the eye sees them in daylight, from ten bands or more between 380 and 780 nm."""

    __slots__ = ()
    _ron = "Cie"

    exposure_stops: float | str | None
    """Stops over the exposure that shows a white surface on the horizontal as white; automatic if absent."""

    def __init__(self, *, exposure_stops: float | str | None | Unset = ...) -> None:
        super().__init__(exposure_stops=exposure_stops)

Cie._keys = {key['name']: key for key in _variant_keys("Picture", "Cie")}

Picture.Cie = _VARIANTS["Picture"]["Cie"] = Cie


class System(Choice):
    """A transport system."""

    __slots__ = ()

    Backward: ClassVar[type[Backward]]
    Forward: ClassVar[type[Forward]]
    Analog: ClassVar[type[Analog]]
    FirstOrder: ClassVar[type[FirstOrder]]
    Reference: ClassVar[type[Reference]]

_CLASSES["System"] = System
_VARIANTS["System"] = {}


class Backward(System, Variant):
    """Paths from the sensor."""

    __slots__ = ()
    _ron = "Backward"

System.Backward = _VARIANTS["System"]["Backward"] = Backward


class Forward(System, Variant):
    """Photon packets from sun and sky, or from what emits."""

    __slots__ = ()
    _ron = "Forward"

System.Forward = _VARIANTS["System"]["Forward"] = Forward


class Analog(System, Variant):
    """Photons of one band each, absorbed, reflected or transmitted as a whole: slow, and free of all that could be wrong with packets. For `Photons`, without views."""

    __slots__ = ()
    _ron = "Analog"

System.Analog = _VARIANTS["System"]["Analog"] = Analog


class FirstOrder(System, Variant):
    """Light of sun and sky that was scattered once, integrated over low-discrepancy points with no random walk. For images and directions: of `Orders` the parts `_uc` and `_co_sgl`, and, where `first_order_only` is, `Brf` and `Radiance`."""

    __slots__ = ()
    _ron = "FirstOrder"

System.FirstOrder = _VARIANTS["System"]["FirstOrder"] = FirstOrder


class Reference(System, Variant):
    """Paths from the sensor as one plain loop, for comparison: slow. For images and directions: `Brf` and `Radiance` of what is reflected."""

    __slots__ = ()
    _ron = "Reference"

System.Reference = _VARIANTS["System"]["Reference"] = Reference


class Look(Choice):
    """Direction or point that a fisheye camera looks at."""

    __slots__ = ()

    Up: ClassVar[type[Up]]
    Down: ClassVar[type[Down]]
    Towards: ClassVar[type[Towards]]
    Target: ClassVar[type[Target]]

_CLASSES["Look"] = Look
_VARIANTS["Look"] = {}


class Up(Look, Variant):
    """Straight up; north is at the top of the image and east on its left, as in a photograph."""

    __slots__ = ()
    _ron = "Up"

Look.Up = _VARIANTS["Look"]["Up"] = Up


class Down(Look, Variant):
    """Straight down; north is at the top of the image."""

    __slots__ = ()
    _ron = "Down"

Look.Down = _VARIANTS["Look"]["Down"] = Down


class Towards(Look, Variant):
    """A direction."""

    __slots__ = ()
    _ron = "Towards"

    zenith_deg: float | str
    """Angle of the view from the upward vertical, degrees: 90 is the horizon."""
    azimuth_deg: float | str
    """Azimuth of the direction, clockwise from north, degrees."""

    def __init__(self, *, zenith_deg: float | str | Unset = ..., azimuth_deg: float | str | Unset = ...) -> None:
        super().__init__(zenith_deg=zenith_deg, azimuth_deg=azimuth_deg)

Towards._keys = {key['name']: key for key in _variant_keys("Look", "Towards")}

Look.Towards = _VARIANTS["Look"]["Towards"] = Towards


class Target(Look, Variant):
    """A point."""

    __slots__ = ()
    _ron = "Target"

    at_m: tuple[float | str, float | str, float | str]
    """The point, m."""

    def __init__(self, *, at_m: tuple[float | str, float | str, float | str] | Array | Unset = ...) -> None:
        super().__init__(at_m=at_m)

Target._keys = {key['name']: key for key in _variant_keys("Look", "Target")}

Look.Target = _VARIANTS["Look"]["Target"] = Target


class FisheyeProjection(Choice):
    """Mapping of an angle θ off the axis to the distance from the middle of a fisheye image."""

    __slots__ = ()

    Equisolid: ClassVar[type[Equisolid]]
    Equidistant: ClassVar[type[Equidistant]]
    Orthographic: ClassVar[type[FisheyeProjectionOrthographic]]
    Stereographic: ClassVar[type[Stereographic]]

_CLASSES["FisheyeProjection"] = FisheyeProjection
_VARIANTS["FisheyeProjection"] = {}


class Equisolid(FisheyeProjection, Variant):
    """Proportional to sin(θ/2): equal areas of the image are equal solid angles."""

    __slots__ = ()
    _ron = "Equisolid"

FisheyeProjection.Equisolid = _VARIANTS["FisheyeProjection"]["Equisolid"] = Equisolid


class Equidistant(FisheyeProjection, Variant):
    """Proportional to θ."""

    __slots__ = ()
    _ron = "Equidistant"

FisheyeProjection.Equidistant = _VARIANTS["FisheyeProjection"]["Equidistant"] = Equidistant


class FisheyeProjectionOrthographic(FisheyeProjection, Variant):
    """Proportional to sin θ: equal areas of the image are equal fractions of the irradiance."""

    __slots__ = ()
    _ron = "Orthographic"

FisheyeProjection.Orthographic = _VARIANTS["FisheyeProjection"]["Orthographic"] = FisheyeProjectionOrthographic


class Stereographic(FisheyeProjection, Variant):
    """Proportional to tan(θ/2): circles stay circles."""

    __slots__ = ()
    _ron = "Stereographic"

FisheyeProjection.Stereographic = _VARIANTS["FisheyeProjection"]["Stereographic"] = Stereographic


class Views(Choice):
    """Directions towards sensors."""

    __slots__ = ()

    PrincipalPlane: ClassVar[type[PrincipalPlane]]
    CrossPlane: ClassVar[type[CrossPlane]]
    List: ClassVar[type[ViewsList]]

_CLASSES["Views"] = Views
_VARIANTS["Views"] = {}


class PrincipalPlane(Views, Variant):
    """Directions in the sun's vertical plane; positive angles are on the sun's side."""

    __slots__ = ()
    _ron = "PrincipalPlane"

    max_deg: float | str
    """Largest zenith angle, degrees."""
    step_deg: float | str
    """Step, degrees."""

    def __init__(self, *, max_deg: float | str | Unset = ..., step_deg: float | str | Unset = ...) -> None:
        super().__init__(max_deg=max_deg, step_deg=step_deg)

PrincipalPlane._keys = {key['name']: key for key in _variant_keys("Views", "PrincipalPlane")}

Views.PrincipalPlane = _VARIANTS["Views"]["PrincipalPlane"] = PrincipalPlane


class CrossPlane(Views, Variant):
    """Directions in the plane perpendicular to it; positive angles are 90° clockwise of the sun."""

    __slots__ = ()
    _ron = "CrossPlane"

    max_deg: float | str
    """Largest zenith angle, degrees."""
    step_deg: float | str
    """Step, degrees."""

    def __init__(self, *, max_deg: float | str | Unset = ..., step_deg: float | str | Unset = ...) -> None:
        super().__init__(max_deg=max_deg, step_deg=step_deg)

CrossPlane._keys = {key['name']: key for key in _variant_keys("Views", "CrossPlane")}

Views.CrossPlane = _VARIANTS["Views"]["CrossPlane"] = CrossPlane


class ViewsList(Views, Variant):
    """Pairs (zenith, azimuth), degrees."""

    __slots__ = ()
    _ron = "List"

    value: list[tuple[float | str, float | str]]

    def __init__(self, value: list[tuple[float | str, float | str]] | Array, /) -> None:
        super().__init__(value)

ViewsList._holds = _variant_holds("Views", "List")
ViewsList._keys = {"value": {"schema": ViewsList._holds, "default": None}}

Views.List = _VARIANTS["Views"]["List"] = ViewsList


class PhotonMeasure(Choice):
    """Quantity that photons are counted for."""

    __slots__ = ()

    BrfCells: ClassVar[type[BrfCells]]
    BrfViews: ClassVar[type[BrfViews]]
    BrfCones: ClassVar[type[BrfCones]]
    Albedo: ClassVar[type[Albedo]]
    RadianceCells: ClassVar[type[RadianceCells]]
    RadianceViews: ClassVar[type[RadianceViews]]
    RadianceCones: ClassVar[type[RadianceCones]]
    Exitance: ClassVar[type[Exitance]]
    BrightnessTemperature: ClassVar[type[PhotonMeasureBrightnessTemperature]]
    Orders: ClassVar[type[PhotonMeasureOrders]]
    Fapar: ClassVar[type[Fapar]]
    Absorbed: ClassVar[type[Absorbed]]
    Fluxes: ClassVar[type[Fluxes]]

_CLASSES["PhotonMeasure"] = PhotonMeasure
_VARIANTS["PhotonMeasure"] = {}


class BrfCells(PhotonMeasure, Variant):
    """BRF in this number of equal-area cells of the hemisphere."""

    __slots__ = ()
    _ron = "BrfCells"

    value: int | str

    def __init__(self, value: int | str, /) -> None:
        super().__init__(value)

BrfCells._holds = _variant_holds("PhotonMeasure", "BrfCells")
BrfCells._keys = {"value": {"schema": BrfCells._holds, "default": None}}

PhotonMeasure.BrfCells = _VARIANTS["PhotonMeasure"]["BrfCells"] = BrfCells


class BrfViews(PhotonMeasure, Variant):
    """BRF towards directions, by virtual photons."""

    __slots__ = ()
    _ron = "BrfViews"

    value: Views

    def __init__(self, value: Views, /) -> None:
        super().__init__(value)

BrfViews._holds = _variant_holds("PhotonMeasure", "BrfViews")
BrfViews._keys = {"value": {"schema": BrfViews._holds, "default": None}}

PhotonMeasure.BrfViews = _VARIANTS["PhotonMeasure"]["BrfViews"] = BrfViews


class BrfCones(PhotonMeasure, Variant):
    """BRF within cones: (zenith, azimuth, full opening angle), degrees."""

    __slots__ = ()
    _ron = "BrfCones"

    value: list[tuple[float | str, float | str, float | str]]

    def __init__(self, value: list[tuple[float | str, float | str, float | str]] | Array, /) -> None:
        super().__init__(value)

BrfCones._holds = _variant_holds("PhotonMeasure", "BrfCones")
BrfCones._keys = {"value": {"schema": BrfCones._holds, "default": None}}

PhotonMeasure.BrfCones = _VARIANTS["PhotonMeasure"]["BrfCones"] = BrfCones


class Albedo(PhotonMeasure, Variant):
    """Reflected over incident flux."""

    __slots__ = ()
    _ron = "Albedo"

PhotonMeasure.Albedo = _VARIANTS["PhotonMeasure"]["Albedo"] = Albedo


class RadianceCells(PhotonMeasure, Variant):
    """Radiance in this number of equal-area cells of the hemisphere, W m⁻² sr⁻¹ nm⁻¹, from the sources that the band names; of an isolated scene, over the terrain's rectangle."""

    __slots__ = ()
    _ron = "RadianceCells"

    value: int | str

    def __init__(self, value: int | str, /) -> None:
        super().__init__(value)

RadianceCells._holds = _variant_holds("PhotonMeasure", "RadianceCells")
RadianceCells._keys = {"value": {"schema": RadianceCells._holds, "default": None}}

PhotonMeasure.RadianceCells = _VARIANTS["PhotonMeasure"]["RadianceCells"] = RadianceCells


class RadianceViews(PhotonMeasure, Variant):
    """Radiance towards directions, by virtual photons."""

    __slots__ = ()
    _ron = "RadianceViews"

    value: Views

    def __init__(self, value: Views, /) -> None:
        super().__init__(value)

RadianceViews._holds = _variant_holds("PhotonMeasure", "RadianceViews")
RadianceViews._keys = {"value": {"schema": RadianceViews._holds, "default": None}}

PhotonMeasure.RadianceViews = _VARIANTS["PhotonMeasure"]["RadianceViews"] = RadianceViews


class RadianceCones(PhotonMeasure, Variant):
    """Radiance within cones: (zenith, azimuth, full opening angle), degrees."""

    __slots__ = ()
    _ron = "RadianceCones"

    value: list[tuple[float | str, float | str, float | str]]

    def __init__(self, value: list[tuple[float | str, float | str, float | str]] | Array, /) -> None:
        super().__init__(value)

RadianceCones._holds = _variant_holds("PhotonMeasure", "RadianceCones")
RadianceCones._keys = {"value": {"schema": RadianceCones._holds, "default": None}}

PhotonMeasure.RadianceCones = _VARIANTS["PhotonMeasure"]["RadianceCones"] = RadianceCones


class Exitance(PhotonMeasure, Variant):
    """Flux density that leaves upwards, W m⁻² nm⁻¹, from the sources that the band names."""

    __slots__ = ()
    _ron = "Exitance"

PhotonMeasure.Exitance = _VARIANTS["PhotonMeasure"]["Exitance"] = Exitance


class PhotonMeasureBrightnessTemperature(PhotonMeasure, Variant):
    """Temperature of the black body of each radiance that this sensor measures, K, in bands that hold emission."""

    __slots__ = ()
    _ron = "BrightnessTemperature"

PhotonMeasure.BrightnessTemperature = _VARIANTS["PhotonMeasure"]["BrightnessTemperature"] = PhotonMeasureBrightnessTemperature


class PhotonMeasureOrders(PhotonMeasure, Variant):
    """Splits this sensor's albedo and BRF as RAMI does: `_uc` (scattered once, by the ground), `_co_sgl` (once, by anything else) and `_mlt` (more often)."""

    __slots__ = ()
    _ron = "Orders"

PhotonMeasure.Orders = _VARIANTS["PhotonMeasure"]["Orders"] = PhotonMeasureOrders


class Fapar(PhotonMeasure, Variant):
    """Share of the incident flux that each material absorbs in each layer and in all, and what reaches the ground."""

    __slots__ = ()
    _ron = "Fapar"

    layer_m: float | str | list[float | str]
    """Thickness of a layer from the lowest ground up, m, or the heights of all borders between layers in the local frame, m."""

    def __init__(self, *, layer_m: float | str | list[float | str] | Array | Unset = ...) -> None:
        super().__init__(layer_m=layer_m)

Fapar._keys = {key['name']: key for key in _variant_keys("PhotonMeasure", "Fapar")}

PhotonMeasure.Fapar = _VARIANTS["PhotonMeasure"]["Fapar"] = Fapar


class Absorbed(PhotonMeasure, Variant):
    """Power of sun and sky that each instance absorbs, W nm⁻¹, the terrain as the first of them."""

    __slots__ = ()
    _ron = "Absorbed"

    per: Per
    """`Triangle` reports what each triangle and disc absorbs too, as a coloured PLY."""

    def __init__(self, *, per: Per | Unset = ...) -> None:
        super().__init__(per=per)

Absorbed._keys = {key['name']: key for key in _variant_keys("PhotonMeasure", "Absorbed")}

PhotonMeasure.Absorbed = _VARIANTS["PhotonMeasure"]["Absorbed"] = Absorbed


class Fluxes(PhotonMeasure, Variant):
    """Down- and upwelling flux density, W m⁻² nm⁻¹, on the terrain and at the top of the scene, from the sources that the band names: per m² of horizontal area and, on relief, also per m² of the inclined ground (`_terrain_surface`)."""

    __slots__ = ()
    _ron = "Fluxes"

    pixel_m: float | str
    """Side of a square pixel, m."""
    heights_m: list[float | str]
    """Further heights in the local frame, m."""

    def __init__(self, *, pixel_m: float | str | Unset = ..., heights_m: list[float | str] | Array | Unset = ...) -> None:
        super().__init__(pixel_m=pixel_m, heights_m=heights_m)

Fluxes._keys = {key['name']: key for key in _variant_keys("PhotonMeasure", "Fluxes")}

PhotonMeasure.Fluxes = _VARIANTS["PhotonMeasure"]["Fluxes"] = Fluxes


class Per(Choice):
    """Resolution of absorbed power, from coarse to fine."""

    __slots__ = ()

    Instance: ClassVar[type[Instance]]
    Triangle: ClassVar[type[Triangle]]

_CLASSES["Per"] = Per
_VARIANTS["Per"] = {}


class Instance(Per, Variant):
    """Each instance."""

    __slots__ = ()
    _ron = "Instance"

Per.Instance = _VARIANTS["Per"]["Instance"] = Instance


class Triangle(Per, Variant):
    """Each instance, and each of its triangles and discs."""

    __slots__ = ()
    _ron = "Triangle"

Per.Triangle = _VARIANTS["Per"]["Triangle"] = Triangle


class Transport(Record):
    """Options of the light transport."""

    __slots__ = ()
    _ron = ""

    seed: int | str
    """Another number is another, independent estimate."""
    roulette: Roulette
    """Russian roulette of weak paths."""
    first_order_only: bool
    """Count light that was scattered once, and no more."""
    max_order: int | str | None
    """Count light that was scattered so often at most."""

    def __init__(self, *, seed: int | str | Unset = ..., roulette: Roulette | Unset = ..., first_order_only: bool | Unset = ..., max_order: int | str | None | Unset = ...) -> None:
        super().__init__(seed=seed, roulette=roulette, first_order_only=first_order_only, max_order=max_order)

Transport._keys = {key['name']: key for key in _TYPES["Transport"]["x-keys"]}

_CLASSES["Transport"] = Transport


class Roulette(Record):
    """Russian roulette: from some order on a path ends with some probability; those that survive carry its power on. Where that would give them more than they started with, fewer end."""

    __slots__ = ()
    _ron = ""

    after_order: int | str
    """Orders of scattering before it starts."""
    kill: float | str
    """Probability to end, below 1."""

    def __init__(self, *, after_order: int | str | Unset = ..., kill: float | str | Unset = ...) -> None:
        super().__init__(after_order=after_order, kill=kill)

Roulette._keys = {key['name']: key for key in _TYPES["Roulette"]["x-keys"]}

_CLASSES["Roulette"] = Roulette


class FileFormat(Choice):
    """File format of images; the last two hold tables too."""

    __slots__ = ()

    Exr: ClassVar[type[Exr]]
    Envi: ClassVar[type[Envi]]
    GeoTiff: ClassVar[type[GeoTiff]]
    Png: ClassVar[type[Png]]
    Zarr: ClassVar[type[Zarr]]
    NetCdf: ClassVar[type[NetCdf]]

_CLASSES["FileFormat"] = FileFormat
_VARIANTS["FileFormat"] = {}


class Exr(FileFormat, Variant):
    """`OpenEXR`: a float32 channel per band, its standard error and the coverage."""

    __slots__ = ()
    _ron = "Exr"

FileFormat.Exr = _VARIANTS["FileFormat"]["Exr"] = Exr


class Envi(FileFormat, Variant):
    """ENVI rasters of float32 with text headers, `.img` and `.img.hdr`; standard errors and coverage in a second one, `_se.img`."""

    __slots__ = ()
    _ron = "Envi"

FileFormat.Envi = _VARIANTS["FileFormat"]["Envi"] = Envi


class GeoTiff(FileFormat, Variant):
    """Cloud-optimised `GeoTIFF` of float32, a band per spectral band; standard errors and coverage in a second one, `_se.tif`."""

    __slots__ = ()
    _ron = "GeoTiff"

FileFormat.GeoTiff = _VARIANTS["FileFormat"]["GeoTiff"] = GeoTiff


class Png(FileFormat, Variant):
    """Pictures for the eye, with a legend and without."""

    __slots__ = ()
    _ron = "Png"

FileFormat.Png = _VARIANTS["FileFormat"]["Png"] = Png


class Zarr(FileFormat, Variant):
    """Zarr store of all that a sensor measures, `<sensor>.zarr`: version 2 of the format, CF conventions."""

    __slots__ = ()
    _ron = "Zarr"

FileFormat.Zarr = _VARIANTS["FileFormat"]["Zarr"] = Zarr


class NetCdf(FileFormat, Variant):
    """`NetCDF` file of all that a sensor measures, `<sensor>.nc`: classic format, CF conventions."""

    __slots__ = ()
    _ron = "NetCdf"

FileFormat.NetCdf = _VARIANTS["FileFormat"]["NetCdf"] = NetCdf


class Sweep(Choice):
    """Points that `sunfleck sweep` runs a scene at."""

    __slots__ = ()

    Grid: ClassVar[type[SweepGrid]]
    Zip: ClassVar[type[Zip]]
    Derivatives: ClassVar[type[Derivatives]]

_CLASSES["Sweep"] = Sweep
_VARIANTS["Sweep"] = {}


class SweepGrid(Sweep, Variant):
    """Every combination of the parameters' values; the last parameter varies fastest."""

    __slots__ = ()
    _ron = "Grid"

    value: dict[str, list[float | str]]

    def __init__(self, value: Mapping[str, list[float | str]] | Array, /) -> None:
        super().__init__(value)

SweepGrid._holds = _variant_holds("Sweep", "Grid")
SweepGrid._keys = {"value": {"schema": SweepGrid._holds, "default": None}}

Sweep.Grid = _VARIANTS["Sweep"]["Grid"] = SweepGrid


class Zip(Sweep, Variant):
    """The first values of all parameters, then the second ones, and so on."""

    __slots__ = ()
    _ron = "Zip"

    value: dict[str, list[float | str]]

    def __init__(self, value: Mapping[str, list[float | str]] | Array, /) -> None:
        super().__init__(value)

Zip._holds = _variant_holds("Sweep", "Zip")
Zip._keys = {"value": {"schema": Zip._holds, "default": None}}

Sweep.Zip = _VARIANTS["Sweep"]["Zip"] = Zip


class Derivatives(Sweep, Variant):
    """The scene as it is, and at both sides of it in each parameter: `derivatives.csv` has the derivatives of results with respect to them, central differences with standard errors. `["cab", "lai"]` takes steps of 1 % of the parameters; `{ "sza": 0.5 }` names the steps, for parameters that may be 0."""

    __slots__ = ()
    _ron = "Derivatives"

    value: list[str] | dict[str, float | str]

    def __init__(self, value: list[str] | Mapping[str, float | str] | Array, /) -> None:
        super().__init__(value)

Derivatives._holds = _variant_holds("Sweep", "Derivatives")
Derivatives._keys = {"value": {"schema": Derivatives._holds, "default": None}}

Sweep.Derivatives = _VARIANTS["Sweep"]["Derivatives"] = Derivatives

__all__ = [
    "Absorbed",
    "Albedo",
    "All",
    "Analog",
    "Angstroms",
    "Area",
    "AreaTable",
    "AstmE490",
    "AstmG173",
    "AsymmetricGaussian",
    "Auto",
    "Axis",
    "Backward",
    "Band",
    "BandSet",
    "BandSetSensor",
    "BandSource",
    "BaseCenter",
    "Beta",
    "BlackBody",
    "Both",
    "Boundary",
    "Branches",
    "Brf",
    "BrfCells",
    "BrfCones",
    "BrfViews",
    "CanopyHeights",
    "Cie",
    "Clumps",
    "Coating",
    "Cone",
    "Constant",
    "Coordinates",
    "Count",
    "Cover",
    "CrossPlane",
    "Crown",
    "CrownShape",
    "CrownShapeBox",
    "Cylinder",
    "Degrees",
    "Density",
    "Derivatives",
    "Directions",
    "Disc",
    "Discs",
    "Distribution",
    "DistributionUniform",
    "Down",
    "Each",
    "Ellipsoid",
    "Ellipsoidal",
    "Emission",
    "Envi",
    "Equidistant",
    "Equisolid",
    "Erectophile",
    "Even",
    "Exitance",
    "Exr",
    "Extremophile",
    "Faces",
    "Fapar",
    "File",
    "FileFormat",
    "Fill",
    "FirstOrder",
    "Fisheye",
    "FisheyeProjection",
    "FisheyeProjectionOrthographic",
    "Fixed",
    "Fluxes",
    "Forward",
    "FourComponents",
    "Frame",
    "GapFraction",
    "Gaussian",
    "GeoJson",
    "GeoTiff",
    "Gltf",
    "Group",
    "HalfEllipsoid",
    "Height",
    "Hole",
    "Hyperspectral",
    "ImageMeasure",
    "ImageMeasureBrightnessTemperature",
    "ImageMeasureOrders",
    "ImageMeasureRadiance",
    "Include",
    "Instance",
    "Instances",
    "InstancesList",
    "InstancesTable",
    "Isolated",
    "Isotropic",
    "Lambertian",
    "LandCover",
    "Leaf",
    "LeafAngle",
    "LeafAngleUniform",
    "LeafProfile",
    "LeafProfileArea",
    "LeafShape",
    "Library",
    "Local",
    "LogNormal",
    "Look",
    "Map",
    "Material",
    "MeanDelta",
    "Mesh",
    "Metres",
    "Micrometres",
    "Named",
    "Nanometres",
    "Neighbours",
    "NetCdf",
    "NoData",
    "Normal",
    "Obj",
    "Origin",
    "PartsBy",
    "PartsByMaterial",
    "Per",
    "PerHectare",
    "Percent",
    "Periodic",
    "Perspective",
    "PhotonMeasure",
    "PhotonMeasureBrightnessTemperature",
    "PhotonMeasureOrders",
    "Photons",
    "Picture",
    "PictureBands",
    "Plagiophile",
    "Plane",
    "Planophile",
    "Ply",
    "Png",
    "PoissonDisc",
    "Polygon",
    "PrincipalPlane",
    "Prospect",
    "Prototype",
    "Quicklook",
    "RadianceCells",
    "RadianceCones",
    "RadianceViews",
    "RasterBands",
    "RasterWindow",
    "Reference",
    "ReflectanceMap",
    "Refuse",
    "RelError",
    "RelErrors",
    "Response",
    "ResponseBox",
    "ResponsePoints",
    "ResponseSensor",
    "ResponseTable",
    "Rhombus",
    "Roulette",
    "Rpv",
    "Rule",
    "RuleGrid",
    "RuleUniform",
    "Samples",
    "Scatter",
    "Seconds",
    "Sensor",
    "SensorOrthographic",
    "Shoot",
    "Sky",
    "SkyFraction",
    "SkyNone",
    "Soil",
    "Soilspect",
    "Spa",
    "Spectrum",
    "SpectrumBands",
    "SpectrumPoints",
    "SpectrumTable",
    "Spherical",
    "Square",
    "Stems",
    "StemsRaster",
    "Stereographic",
    "StopCriterion",
    "Sun",
    "SunPosition",
    "Sunlight",
    "SunlitShaded",
    "Sweep",
    "SweepGrid",
    "System",
    "TableCoordinates",
    "Target",
    "Temperature",
    "TemperatureUniform",
    "Terrain",
    "TerrainRaster",
    "ThermalSky",
    "ThermalSkyNone",
    "ThermalSkyRadiance",
    "Towards",
    "Transport",
    "Triangle",
    "Trunk",
    "Up",
    "ValueUnit",
    "ValueUnitFraction",
    "Views",
    "ViewsList",
    "VirtualPlane",
    "WavelengthUnit",
    "Wavelengths",
    "Wavenumbers",
    "WholeScene",
    "X",
    "Y",
    "Z",
    "Zarr",
    "Zip",
]
